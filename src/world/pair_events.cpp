// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/pair_events.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pairs/pair_order.h"
#include "world/pair_margin.h"

namespace hgrid {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Calls `look` with the two boxes of each pair of shapes of two bodies, until it returns true.
template <class Look>
bool anyBoxes(const PairsNow& now, std::uint32_t first, std::uint32_t second, Look&& look) {
  const std::vector<std::uint32_t>& begin = now.structure->first_proxy;
  for (std::uint32_t a = begin[first]; a < begin[first + 1]; ++a) {
    for (std::uint32_t b = begin[second]; b < begin[second + 1]; ++b) {
      if (look(now.boxes[a], now.boxes[b])) return true;
    }
  }
  return false;
}

/// Returns whether boxes alone do not determine the gap of two bodies, because one of them is a map or has a plane.
bool isSpecial(const PairsNow& now, std::uint32_t first, std::uint32_t second) {
  const Structure& structure = *now.structure;
  return structure.isMap(first) || structure.isMap(second) || structure.hasPlane(first) || structure.hasPlane(second);
}

bool within(const PairsNow& now, std::uint32_t first, std::uint32_t second, double reach) {
  if (isSpecial(now, first, second)) return now.special_gap(first, second, reach) <= reach;
  return anyBoxes(now, first, second, [&](const Aabb& a, const Aabb& b) { return withinDistance(a, b, reach); });
}

double gapOf(const PairsNow& now, std::uint32_t first, std::uint32_t second) {
  double gap = std::numeric_limits<double>::infinity();
  if (isSpecial(now, first, second)) return now.special_gap(first, second, gap);
  anyBoxes(now, first, second, [&](const Aabb& a, const Aabb& b) {
    gap = std::min(gap, distance(a, b));
    return false;
  });
  return gap;
}

}  // namespace

void PairEvents::beginEpoch() {
  epoch_began_ = true;
  last_ = 0;
}

/// Finds the index of each body of the previous structure in the present structure, and the reverse. Both structures
/// are sorted by name, so pairs keep their order. A pair ends if one of its bodies was removed, or was replaced by
/// another body of the same name. In a new epoch only the name counts, because a reset replaces obstacles by equal
/// obstacles.
void PairEvents::renumber(const Structure& now, PairEventList& list) {
  const Structure& was = *structure_;
  before_.assign(now.bodies.size(), kNone);
  after_.assign(was.bodies.size(), kNone);
  for (std::uint32_t i = 0, j = 0; i < was.bodies.size() && j < now.bodies.size();) {
    const int order = was.bodies[i].name.compare(now.bodies[j].name);
    const bool same = order == 0 && was.ids[i] == now.ids[j];
    if (same) before_[j] = i;
    if (same || (order == 0 && epoch_began_)) after_[i] = j;
    i += order <= 0 ? 1 : 0;
    j += order >= 0 ? 1 : 0;
  }
  carried_over_.clear();
  for (const On& on : on_) {
    if (after_[on.first] != kNone && after_[on.second] != kNone) {
      carried_over_.push_back({after_[on.first], after_[on.second], on.since});
    } else if (!epoch_began_) {
      list.before = structure_;
      list.events.push_back({0, EventKind::end, EventCause::bodies, on.first, on.second, on.since,
                             std::numeric_limits<double>::quiet_NaN()});
    }
  }
}

double PairEvents::marginBefore(std::uint32_t first, std::uint32_t second) const {
  if (known_.empty()) return configuredMargin(*structure_, first, second);
  const Known &a = known_[first], &b = known_[second];
  return pairMargin(*structure_, first, {a.growth, a.cohort}, second, {b.growth, b.cohort});
}

/// Returns why a pair began. If the gap is also within the margin of the previous tick, the cause is a movement of the
/// bodies, even if the margin has changed too.
EventCause PairEvents::causeOfBegin(const NearPair& pair, const Structure& now) const {
  const std::uint32_t first = numberBefore(pair.first), second = numberBefore(pair.second);
  if (first == kNone || second == kNone) return EventCause::bodies;
  if (!known_.empty() && !(known_[first].placed && known_[second].placed)) return EventCause::bodies;
  if (structure_->filter.allowed(first, second)) return EventCause::filter;
  const double margin = marginBefore(first, second);
  if (pair.margin <= margin || pair.gap <= margin) return EventCause::moved;
  const bool is_wider = configuredMargin(now, pair.first, pair.second) > configuredMargin(*structure_, first, second);
  return is_wider ? EventCause::filter : EventCause::staleness;
}

/// Returns why a pair ended. If the gap also exceeds the margin of the previous tick, the cause is a movement of the
/// bodies, even if the margin has changed too.
EventCause PairEvents::causeOfEnd(const On& on, double margin, double gap, const Structure& now) const {
  if (now.filter.allowed(on.first, on.second)) return EventCause::filter;
  const std::uint32_t first = numberBefore(on.first), second = numberBefore(on.second);
  const double margin_before = marginBefore(first, second);
  const double kept_before = margin_before + hysteresis_before_;  // [m] up to this gap, the previous tick kept the pair
  if (margin + hysteresis_ >= kept_before || gap > kept_before) return EventCause::moved;
  const bool is_narrower = configuredMargin(now, on.first, on.second) + hysteresis_ <
                           configuredMargin(*structure_, first, second) + hysteresis_before_;
  return is_narrower ? EventCause::filter : EventCause::staleness;
}

/// Decides whether a pair that is on but not listed ends. It stays on if its gap exceeds the margin by at most the
/// hysteresis, or if only truncation removed it from the list.
void PairEvents::judge(const On& on, const PairsNow& now, PairEventList& list) {
  if (epoch_began_) return;  // in a new epoch, only listed pairs begin again
  const Structure& structure = *now.structure;
  const double margin =
      pairMargin(structure, on.first, stalenessOf(now.poses[on.first]), on.second, stalenessOf(now.poses[on.second]));
  const bool counts = !structure.filter.allowed(on.first, on.second) &&
                      !(now.rooms != nullptr && now.rooms->areSeparate(on.first, on.second));
  if (counts && within(now, on.first, on.second, margin + hysteresis_)) {
    next_.push_back(on);
    return;
  }
  if (now.is_cut && now.is_cut(on.first, on.second)) {  // if the horizon selects a pair, its gap may be larger
    next_.push_back(on);
    return;
  }
  const double gap = gapOf(now, on.first, on.second);
  const double told = std::isfinite(gap) ? gap : std::numeric_limits<double>::quiet_NaN();  // infinite: no cell is left
  list.events.push_back(
      {0, EventKind::end, causeOfEnd(on, margin, gap, structure), on.first, on.second, on.since, told});
}

void PairEvents::begin(const NearPair& pair, EventCause cause, const PairsNow& now) {
  next_.push_back({pair.first, pair.second, now.stamp});
  begun_.push_back({0, EventKind::begin, cause, pair.first, pair.second, now.stamp, pair.gap});
}

void PairEvents::remember(const PairsNow& now) {
  next_structure_ = now.structure;
  next_known_.clear();
  if (now.worst_state < Freshness::stale && now.max_growth == 0.0) return;
  for (const BodyPose& pose : now.poses) {
    next_known_.push_back({pose.growth, pose.cohort, pose.state != Freshness::unplaced});
  }
}

void PairEvents::update(const PairsNow& now, PairEventList& list) {
  list.events.clear();
  list.before.reset();
  renumbered_ = now.structure != structure_;
  if (renumbered_) renumber(*now.structure, list);
  next_.clear();
  begun_.clear();
  const std::vector<On>& before_now = renumbered_ ? carried_over_ : on_;
  auto on = before_now.begin();
  for (const NearPair& pair : now.pairs) {
    while (on != before_now.end() && before(*on, pair)) judge(*on++, now, list);
    const bool was_on = on != before_now.end() && !before(pair, *on);
    if (!was_on) {
      const auto not_judged = static_cast<std::size_t>(before_now.end() - on);
      if (next_.size() + not_judged < most_) begin(pair, causeOfBegin(pair, *now.structure), now);
    } else if (epoch_began_) {
      begin(pair, EventCause::epoch, now);
    } else {
      next_.push_back(*on);
    }
    if (was_on) ++on;
  }
  while (on != before_now.end()) judge(*on++, now, list);
  list.events.insert(list.events.end(), begun_.begin(), begun_.end());
  next_last_ = last_;
  for (PairEvent& event : list.events) event.number = ++next_last_;
  list.last = next_last_;
  remember(now);
}

void PairEvents::accept() {
  last_ = next_last_;
  on_.swap(next_);
  structure_ = next_structure_;
  hysteresis_before_ = hysteresis_;
  known_.swap(next_known_);
  epoch_began_ = false;
}

}  // namespace hgrid
