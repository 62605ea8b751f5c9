// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/transform_lookup.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

/// The pose of a frame in its parent.
struct Link {
  std::uint32_t frame = FrameTable::kNone;
  PoseSample sample;
};

/// The links from a frame up to one of its ancestors.
using Links = std::vector<Link>;

/// The links from two frames up to their nearest common ancestor.
struct Chain {
  bool connected = false;  // if false, each list of links ends at the first unknown link
  Links from_frame, from_target;

  FramePose targetFromFrame() const { return product(from_target).inverse() * product(from_frame); }

 private:
  static FramePose product(const Links& links) {
    FramePose ancestor_from_frame;
    for (const Link& link : links) ancestor_from_frame = link.sample.parent_from_frame * ancestor_from_frame;
    return ancestor_from_frame;
  }
};

/// A pose and its time.
struct TimedPose {
  FramePose target_from_frame;
  std::optional<Time> time;  // empty: all transforms of the chain are static
};

/// Reads the stored transforms for one lookup. No thread can change them while this object exists.
class Look {
 public:
  Look(const TransformStore& store, const std::string& target, const std::string& frame)
      : reading_(store), target_(reading_.table().find(target)), frame_(reading_.table().find(frame)) {}

  /// Returns the chain at one time, through the parents that the frames had at that time.
  Chain chainAt(Time time) const {
    return chain([&](std::uint32_t frame) -> std::optional<PoseSample> {
      if (reading_.isFreeButStatic(frame)) return std::nullopt;
      return reading_.history(frame).sampleAt(time);
    });
  }

  /// Returns the chain through the newest parents. Its poses are of different times.
  Chain newestChain() const {
    return chain([&](std::uint32_t frame) -> std::optional<PoseSample> {
      if (reading_.isFreeButStatic(frame)) return std::nullopt;
      const FrameHistory& history = reading_.history(frame);
      const PoseSample& newest = history.newest();
      if (newest.parent == FrameTable::kNone || (history.moves() && newest.stamp.count() == 0)) return std::nullopt;
      return newest;
    });
  }

  /// Returns the pose at the newest time at which all transforms of the newest chain are known.
  std::optional<TimedPose> newest() const {
    const Chain newest = newestChain();
    if (!newest.connected) return std::nullopt;
    std::optional<Time> time = Time::max();
    for (bool settled = false; !settled;) {
      const Time before = *time;
      for (const Links* links : {&newest.from_frame, &newest.from_target}) time = newestKnownTime(*links, time);
      if (!time) return std::nullopt;
      settled = *time == before;
    }
    if (*time == Time::max()) return TimedPose{newest.targetFromFrame(), std::nullopt};
    return TimedPose{chainAt(*time).targetFromFrame(), time};
  }

  /// Says why the pose is not known at a time. Call this only if it is not known.
  std::string whyNot(Time time, const std::string& target, const std::string& frame) const {
    if (frame_ == FrameTable::kNone) return "frame '" + frame + "' was never published";
    if (target_ == FrameTable::kNone) return "frame '" + target + "' was never published";
    const Chain newest = newestChain();
    for (const std::uint32_t end : {lastOf(newest.from_frame, frame_), lastOf(newest.from_target, target_)}) {
      const bool has_parent = reading_.table().parent(end) != FrameTable::kNone;
      if (!newest.connected && has_parent && reading_.isFreeButStatic(end))
        return freeButStatic(reading_.table().name(end));
    }
    if (!newest.connected) return "there is no chain of transforms between them now";
    const Chain known = chainAt(time);
    for (const std::uint32_t end : {lastOf(known.from_frame, frame_), lastOf(known.from_target, target_)}) {
      const FrameHistory& history = reading_.history(end);
      if (history.moves()) return "frame '" + reading_.table().name(end) + "' " + history.knownTimes(time);
    }
    return "there was no chain of transforms between them at that time";
  }

 private:
  static std::uint32_t lastOf(const Links& links, std::uint32_t begin) {
    return links.empty() ? begin : links.back().sample.parent;
  }

  /// Returns the newest time, not after `time`, at which all links are known. Empty: there is none.
  std::optional<Time> newestKnownTime(const Links& links, std::optional<Time> time) const {
    for (const Link& link : links) {
      const FrameHistory& history = reading_.history(link.frame);
      if (time && history.moves()) time = history.newestKnownTime(*time);
    }
    return time;
  }

  /// Returns the chain between the two frames.
  /// @param stepUp  returns the pose of a frame in its parent: std::optional<PoseSample> stepUp(uint32_t)
  template <class StepUp>
  Chain chain(const StepUp& stepUp) const {
    Chain result;
    if (frame_ == FrameTable::kNone || target_ == FrameTable::kNone) return result;
    result.from_frame = linksFrom(frame_, target_, stepUp);
    result.from_target = linksFrom(target_, frame_, stepUp);
    // Shorten both lists of links so that they end at the nearest common ancestor.
    for (std::size_t up = 0; up <= result.from_target.size(); ++up) {
      const std::uint32_t ancestor = up == 0 ? target_ : result.from_target[up - 1].sample.parent;
      const std::optional<std::size_t> steps = stepsTo(ancestor, result.from_frame);
      if (!steps) continue;
      result.connected = true;
      result.from_target.resize(up);
      result.from_frame.resize(*steps);
      break;
    }
    return result;
  }

  /// Returns the links from `begin` up to `end`, or as far as they are known.
  template <class StepUp>
  static Links linksFrom(std::uint32_t begin, std::uint32_t end, const StepUp& stepUp) {
    Links links;
    for (std::uint32_t frame = begin; frame != end && links.size() < FrameTable::kLongestChain;) {
      const std::optional<PoseSample> sample = stepUp(frame);
      if (!sample || sample->parent == FrameTable::kNone) break;
      links.push_back({frame, *sample});
      frame = sample->parent;
    }
    return links;
  }

  std::optional<std::size_t> stepsTo(std::uint32_t ancestor, const Links& links) const {
    if (ancestor == frame_) return 0;
    const auto last =
        std::find_if(links.begin(), links.end(), [&](const Link& link) { return link.sample.parent == ancestor; });
    if (last == links.end()) return std::nullopt;
    return static_cast<std::size_t>(last - links.begin()) + 1;
  }

  TransformStore::Reading reading_;
  std::uint32_t target_, frame_;
};

}  // namespace

std::string freeButStatic(const std::string& frame) {
  return "a planar or floating joint moves frame '" + printable(frame) +
         "', but the frame is only on /tf_static, where robot_state_publisher sends a planar joint as if it were "
         "fixed; "
         "publish the frame's pose on /tf (odometry, localization), or make the joint fixed in the URDF";
}

bool TransformLookup::isConnected(const std::string& target, const std::string& frame) const {
  return frame == target || Look(store_, target, frame).newestChain().connected;
}

bool TransformLookup::isKnown(const std::string& target, const std::string& frame, Time time) const {
  return frame == target || Look(store_, target, frame).chainAt(time).connected;
}

std::optional<FramePose> TransformLookup::at(const std::string& target, const std::string& frame, Time time,
                                             std::string* why_not) const {
  if (frame == target) return FramePose{};
  const Look look(store_, target, frame);
  const Chain chain = look.chainAt(time);
  if (chain.connected) return chain.targetFromFrame();
  if (why_not != nullptr) *why_not = look.whyNot(time, target, frame);
  return std::nullopt;
}

std::optional<FramePose> TransformLookup::newest(const std::string& target, const std::string& frame) const {
  if (frame == target) return FramePose{};
  const std::optional<TimedPose> newest = Look(store_, target, frame).newest();
  return newest ? std::optional<FramePose>(newest->target_from_frame) : std::nullopt;
}

Pose TransformLookup::atOrNewest(const std::string& target, const std::string& frame, Time time, double max_apart,
                                 const std::string& what) const {
  if (frame == target) return Pose::Identity();
  std::string why_not;
  std::optional<FramePose> pose = at(target, frame, time, &why_not);
  if (!pose) {
    const std::optional<TimedPose> newest = Look(store_, target, frame).newest();
    if (!newest)
      throw Refusal(Code::unknown_frame, what + " is not connected to '" + target + "': " + printable(why_not, 300));
    if (newest->time && std::abs(seconds(*newest->time - time)) > max_apart) {
      throw Refusal(Code::extrapolation, what + " is last known at " + text(seconds(*newest->time)) +
                                             " s, but the world is at " + text(seconds(time)) +
                                             " s; the two times may differ by at most " + text(max_apart) +
                                             " s (~stale_after)");
    }
    pose = newest->target_from_frame;
  }
  return checkedPose(pose->translation, pose->rotation.coeffs(), what);
}

std::string TransformLookup::nearestAbove(const std::string& frame,
                                          const std::map<std::string, std::uint32_t>& frames) const {
  const TransformStore::Reading reading(store_);
  std::uint32_t next = reading.table().find(frame);
  for (std::size_t steps = 0; next != FrameTable::kNone && steps < FrameTable::kLongestChain; ++steps) {
    next = reading.table().parent(next);
    if (next == FrameTable::kNone) break;
    const std::string& name = reading.table().name(next);
    if (frames.count(name) > 0) return name;
  }
  return {};
}

}  // namespace hgrid
