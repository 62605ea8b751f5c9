// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_intake.h"

#include <algorithm>
#include <cmath>

#include "node/text/frame_names.h"
#include "node/tf/transform_check.h"

namespace hgrid {
namespace {

constexpr Time kLeastPatience{50000000};   // [ns] a holder may always be silent for this long
constexpr Time kMostPatience{3000000000};  // [ns] no holder may be silent for longer
constexpr double kUnitTolerance = 1e-6;    // a quaternion whose length differs by more is counted

/// Whether the length of a quaternion differs from 1 by more than kUnitTolerance.
bool needsNormalization(const std::array<double, 4>& rotation) {
  const double squared = squaredLength(rotation);
  if (std::abs(squared - 1.0) <= kUnitTolerance) return false;  // the square differs from 1 by more than the length
  return std::abs(std::sqrt(squared) - 1.0) > kUnitTolerance;
}

}  // namespace

TfIntake::TfIntake(double max_future, double cache, std::size_t max_frames, bool simulated, Ledger& ledger,
                   std::size_t max_samples, double max_wait)
    : max_future_(max_future),
      most_late_(max_frames),
      ledger_(ledger),
      ages_(simulated),
      store_(Time(std::llround(1e9 * cache)), max_frames, max_samples),
      rivals_(ledger),
      news_(max_wait) {}

void TfIntake::take(const std::vector<TransformView>& transforms, bool is_static, const std::string& publisher,
                    const Moment& now) {
  accepted_ = 0;
  newest_stamp_ = Time(0);
  const std::uint64_t before = table().revision(), static_before = static_revision_;
  Message message{is_static, MessagePublisher(publisher), now, ages_.read(now)};
  {
    const TransformStore::Writing writing(store_);
    for (std::size_t begin = 0; begin < transforms.size(); begin += kAhead) {
      takeSome(&transforms[begin], std::min(kAhead, transforms.size() - begin), message);
    }
  }
  if (table().revision() != before) takeLate(now);  // another frame may be above one that bodies need
  if (table().revision() != before || static_revision_ != static_before) news_.noteStructure();
  if (accepted_ > 0) ledger_.count("tf.accepted", accepted_);
  if (newest_stamp_.count() > 0) publisher_clocks_.note(publisher, newest_stamp_ - now.ros, message.reading);
  if (const std::size_t dropped = store_.takeDropped()) ledger_.count("tf.samples.LIMIT", dropped);
}

/// Takes at most kAhead transforms.
void TfIntake::takeSome(const TransformView* transforms, std::size_t count, Message& message) {
  const std::array<std::uint32_t, kAhead> known = findFrames(transforms, count);
  const std::uint64_t found_at = table().revision();
  for (std::size_t i = 0; i < count; ++i) {
    const TransformView& transform = transforms[i];
    try {
      takeOne(transform, message, table().revision() == found_at ? known[i] : kNone);
    } catch (const Refusal& refusal) {
      noteRefusal(refusal, viewWithoutSlash(transform.child), message);
      if (message.is_static && refusal.code() == Code::limit) keepLate(transform, message.publisher.name());
    }
  }
}

/// Returns the number of the frame of each transform, or kNone if the frame is not known in this parent.
///
/// Also starts to load what is known about these frames into the processor's cache, from which other work has usually
/// removed it since the last message. If each frame were loaded only when its transform is taken, the processor would
/// wait for memory most of the time.
std::array<std::uint32_t, TfIntake::kAhead> TfIntake::findFrames(const TransformView* transforms, std::size_t count) {
  std::array<std::uint32_t, kAhead> known;
  known.fill(kNone);
  for (std::size_t i = 0; i < count; ++i) {
    known[i] = store_.again(viewWithoutSlash(transforms[i].parent), viewWithoutSlash(transforms[i].child));
    if (known[i] == kNone) continue;
    __builtin_prefetch(&frames_[known[i]], 1);
    store_.prefetch(known[i]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (known[i] != kNone) store_.history(known[i]).prefetchNewest();
  }
  return known;
}

void TfIntake::need(const std::vector<std::string>& names, const Moment& now) {
  store_.need(names);
  takeLate(now);
}

void TfIntake::setFree(std::set<std::string, std::less<>> names) {
  if (store_.setFree(std::move(names))) ++static_revision_;
}

/// Keeps a static transform that found no room. It is sent only once, but a body may need it later.
void TfIntake::keepLate(const TransformView& transform, const std::string& publisher) {
  const std::string child(viewWithoutSlash(transform.child)), parent(viewWithoutSlash(transform.parent));
  if (late_.size() < most_late_ || late_.count(child) != 0) {
    late_.insert_or_assign(child, Late{parent, publisher, transform});
  }
}

/// Takes in the kept static transforms of frames that bodies need by now. One of them can make another one needed.
void TfIntake::takeLate(const Moment& now) {
  for (auto next = late_.begin(); next != late_.end();) {
    if (!table().isNeeded(next->first)) {
      ++next;
      continue;
    }
    const std::string child = next->first;
    Late late = std::move(next->second);
    late_.erase(next);
    late.transform.parent = late.parent;
    late.transform.child = child;
    try {
      Message message{true, MessagePublisher(late.publisher), now, ages_.read(now)};
      takeOne(late.transform, message);
      next = late_.begin();
    } catch (const Refusal& refusal) {
      ledger_.refuse("tf.refused", refusal);
      return;
    }
  }
}

/// @param known  number of the frame if it is already known that its parent is the transform's; otherwise kNone
void TfIntake::takeOne(const TransformView& transform, Message& message, std::uint32_t known) {
  Arrival arrival{transform, message.publisher, message.now, message.reading, transform.stamp};
  arrival.transform.parent = viewWithoutSlash(transform.parent);
  arrival.transform.child = viewWithoutSlash(transform.child);
  const std::uint32_t number = admit(arrival, message.is_static, known);
  noteTopic(number, message.is_static);
  arrival.same_publisher = arrival.publisher.is(frames_[number].publisher);
  if (needsNormalization(transform.rotation)) ledger_.count("tf.renormalised");
  if (message.is_static) {
    takeStatic(number, arrival);
  } else {
    takeMoving(number, arrival);
  }
}

/// A refused transform makes a frame INVALID until a valid one arrives. A static transform is sent only once, so only
/// the publisher that placed a static frame can make it INVALID, and only on /tf_static.
void TfIntake::noteRefusal(const Refusal& refusal, std::string_view child, Message& message) {
  report("tf.refused", refusal);
  const std::uint32_t number = table().find(child);
  if (number == kNone || !table().isPlaced(number)) return;
  Frame& frame = frames_[number];
  const bool is_static = message.is_static;
  if (history(number).moves() ? is_static : !is_static || !message.publisher.is(frame.publisher)) return;
  refusals_.insert_or_assign(number, refusal);
  frame.refused = true;
}

/// Counts and logs what is wrong. Writing to the log can take long, so other threads may read meanwhile.
void TfIntake::report(const char* where, const Refusal& refusal) {
  const TransformStore::Pause pause(store_);
  ledger_.refuse(where, refusal);
}

/// Checks a transform, and returns the number of its frame. Allocates the entries of the child and the parent first. So
/// each numbered frame has an entry, even if memory runs out. @param known  as in takeOne()
std::uint32_t TfIntake::admit(Arrival& arrival, bool is_static, std::uint32_t known) {
  const TransformView& transform = arrival.transform;
  if (known == kNone) known = store_.again(transform.parent, transform.child);
  if (known != kNone) {  // the names were checked when the frame got its parent
    checkValues(transform, is_static, arrival.now, max_future_);
    arrival.same_parent = true;
    return known;
  }
  checkTransform(transform, is_static, arrival.now, max_future_);
  if (frames_.size() < table().size() + 2) frames_.resize(2 * table().size() + 8);
  const std::uint32_t number = store_.admit(transform.parent, transform.child);
  arrival.same_parent = table().isInParent(number, transform.parent);
  return number;
}

void TfIntake::noteTopic(std::uint32_t number, bool is_static) {
  Frame& frame = frames_[number];
  const bool had_conflict = frame.hasConflict();
  (is_static ? frame.from_static : frame.from_tf) = true;
  if (had_conflict || !frame.hasConflict()) return;
  const std::string& name = table().name(number);
  conflicts_.insert(std::lower_bound(conflicts_.begin(), conflicts_.end(), name), name);
  report("tf.conflict", Refusal(Code::conflict, "frame '" + printable(name) +
                                                    "' is published on both /tf and /tf_static; it must be published "
                                                    "on only one of them"));
}

void TfIntake::accept(std::uint32_t number) {
  ++accepted_;
  forgetRefusal(number);
}

void TfIntake::forgetRefusal(std::uint32_t number) {
  if (!frames_[number].refused) return;
  frames_[number].refused = false;
  refusals_.erase(number);
}

const Refusal* TfIntake::refusal(std::uint32_t number) const {
  return frames_[number].refused ? &refusals_.at(number) : nullptr;
}

/// Ignores the stamp, which has no meaning for a static transform. A frame that moved becomes static again only if no
/// transform has arrived on /tf for kMostPatience.
void TfIntake::takeStatic(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  const bool moved = history(number).moves();
  if (moved && arrival.reading - frame.pace.received() <= kMostPatience) {
    ledger_.count("tf.ignored.CONFLICT");
    return;
  }
  const FramePose pose = arrival.pose();
  if (!arrival.same_publisher) arrival.publisher.shared();  // if memory runs out here, nothing has changed yet
  if (moved || !(pose == history(number).newest().parent_from_frame)) ++static_revision_;
  store_.fix(number, arrival.transform.parent, pose);
  if (!late_.empty()) late_.erase(table().name(number));  // an older transform of the frame
  frame.pace.forgetPeriod();
  if (!arrival.same_publisher) frame.publisher = arrival.publisher.shared();
  frame.stray = Time(0);
  accept(number);
}

void TfIntake::takeMoving(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  const FrameHistory& history = this->history(number);
  const bool moves = history.moves();
  if (frame.from_static && !moves && !isStream(frame, arrival)) {
    ledger_.count("tf.ignored.CONFLICT");
    return;
  }
  const Time newest = history.newest().stamp;
  if (moves && arrival.stamp == newest) return takeRepeated(number, arrival);
  if (!arrival.same_publisher && isHeld(number, arrival)) return takeRival(number, arrival);
  // A stamp far ahead of the clock counts as the newest only until a transform arrives whose stamp is not ahead.
  const bool was_ahead = isFarAhead(newest, arrival) && arrival.stamp <= arrival.now.ros;
  const bool first = !moves || newest.count() == 0;
  if (!first && arrival.stamp < newest && !was_ahead) return takeOlder(number, arrival);
  const bool other = !first && (!arrival.same_publisher || !arrival.same_parent);
  if (other) changeClaim(number, arrival);
  Step step;
  step.is_period = !first && !other && !was_ahead;
  step.continues = !other && (first || arrival.stamp <= newest + store_.cache());
  takeNewest(number, arrival, step);
  if (first) news_.noteStructure();  // no tick waits for this frame yet
}

/// Whether a static frame has now received two successive transforms on /tf, not just a stray one.
bool TfIntake::isStream(Frame& frame, const Arrival& arrival) const {
  const bool again = frame.stray.count() > 0 && arrival.stamp > frame.stray &&
                     arrival.reading - frame.pace.received() <= kMostPatience;
  frame.stray = arrival.stamp;
  frame.pace.noteReceived(arrival.reading);
  return again;
}

/// Whether the publisher of the newest transform still holds the frame. Call this only for another publisher. A holder
/// keeps the frame if it is silent for up to two periods. While the frame is contested, it may be silent for longer, so
/// that the holder does not change at each gap in its stream.
bool TfIntake::isHeld(std::uint32_t number, const Arrival& arrival) const {
  const Frame& frame = frames_[number];
  if (!history(number).moves() || history(number).newest().stamp.count() == 0) return false;
  const Time two_periods(static_cast<std::int64_t>(2e9 * frame.pace.period()));
  const Time patience = isContested(number, arrival.reading)
                            ? kMostPatience
                            : std::min(kMostPatience, std::max(kLeastPatience, two_periods));
  return arrival.reading - frame.pace.received() <= patience;
}

bool TfIntake::isFarAhead(Time stamp, const Arrival& arrival) const {
  return stamp > arrival.now.ros + store_.cache() / 2;
}

/// Handles a transform with the same stamp as the frame's newest one. If its pose or parent differs, reports that.
void TfIntake::takeRepeated(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  if (arrival.same_parent && arrival.pose() == history(number).newest().parent_from_frame) {
    ledger_.count("tf.repeated");
    return;
  }
  if (!arrival.same_publisher) return takeRival(number, arrival);
  report("tf.ignored",
         Refusal(Code::dup_id, "frame '" + printable(table().name(number)) + "' was sent twice with stamp " +
                                   text(seconds(arrival.stamp)) + " s, but with a different " +
                                   (arrival.same_parent ? "pose" : "parent") + " (by " +
                                   printable(arrival.publisher.name()) + "); the first one is kept"));
  if (!arrival.same_parent) {
    frame.claimed = true;
    const TransformStore::Pause pause(store_);  // a contradiction is logged
    rivals_.contradict(number, holderOf(number), arrival.claim(), arrival.reading);
  }
}

void TfIntake::takeNewest(std::uint32_t number, const Arrival& arrival, const Step& step) {
  Frame& frame = frames_[number];
  if (!arrival.same_publisher) arrival.publisher.shared();  // if memory runs out here, nothing has changed yet
  const Time stamp_before = history(number).newest().stamp;
  const PoseSample sample{arrival.stamp, kNone, step.continues, arrival.pose()};
  if (arrival.same_parent) {
    store_.advance(number, sample, arrival.now.ros);
  } else {
    store_.advance(number, arrival.transform.parent, sample, arrival.now.ros);
  }
  if (step.is_period) {
    frame.pace.noteStep(seconds(arrival.stamp - stamp_before));
  } else if (!arrival.same_publisher || !arrival.same_parent) {
    frame.pace.forgetPeriod();
  }
  frame.pace.noteReceived(arrival.reading, arrival.now.ros);
  news_.note(number, arrival.stamp, arrival.now.ros);
  newest_stamp_ = std::max(newest_stamp_, arrival.stamp);
  if (!arrival.same_publisher) frame.publisher = arrival.publisher.shared();
  accept(number);
  if (!frame.claimed) return;
  if (const auto rival = rivals_.takeWaiting(number, arrival.stamp)) {
    const TransformStore::Pause pause(store_);  // a contradiction is logged
    rivals_.compare(number, holderOf(number), *rival, arrival.reading);
  }
}

/// Stores a transform that is older than the newest one. It makes no pose fresher, but it adds a pose at its stamp.
void TfIntake::takeOlder(std::uint32_t number, const Arrival& arrival) {
  Frame& frame = frames_[number];
  if (!arrival.same_publisher || !arrival.same_parent) return takeRival(number, arrival);
  ledger_.count("tf.out_of_order");
  if (!store_.fill(number, {arrival.stamp, kNone, true, arrival.pose()})) {
    ledger_.count("tf.too_old");
    return;
  }
  // Not the newest stamp, but also not behind the clock: the frame is still being published.
  if (arrival.stamp >= arrival.now.ros) frame.pace.noteReceived(arrival.reading);
  accept(number);
}

/// Handles a transform of a publisher that does not hold the frame. It is compared with the holder's, but not used.
void TfIntake::takeRival(std::uint32_t number, const Arrival& arrival) {
  frames_[number].claimed = true;
  const TransformStore::Pause pause(store_);  // a contradiction is logged
  rivals_.take(number, holderOf(number), {arrival.claim(), arrival.stamp, arrival.pose()}, arrival.reading);
}

FrameRivals::Holder TfIntake::holderOf(std::uint32_t number) const {
  const Frame& frame = frames_[number];
  return {table().name(number),
          {*frame.publisher, table().parentName(number)},
          history(number).newest().stamp,
          [this, number](Time time) { return history(number).at(time); }};
}

/// Notes that, from this transform on, another publisher places the frame, or the same one in another parent.
void TfIntake::changeClaim(std::uint32_t number, const Arrival& arrival) {
  frames_[number].claimed = true;
  const TransformStore::Pause pause(store_);  // a contradiction is logged
  rivals_.change(number, holderOf(number), arrival.claim(), arrival.reading);
}

void TfIntake::forgetStamps() {
  store_.forgetStamps();
  rivals_.forgetTransforms();
  publisher_clocks_.forget();
  for (Frame& frame : frames_) frame.stray = Time(0);
}

void TfIntake::forgetMoving() {
  forgetStamps();
  for (std::uint32_t number = 0; number < table().size(); ++number) {
    frames_[number].pace.forgetPeriod();
    if (history(number).moves()) forgetRefusal(number);
  }
}

void TfIntake::restamp() { forgetStamps(); }

}  // namespace hgrid
