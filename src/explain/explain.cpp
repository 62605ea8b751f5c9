// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/explain/explain.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodies/nearest_names.h"
#include "hgrid_proximity/explain/decided_rule.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "world/body_gap.h"

namespace hgrid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostRooms = 4;  // most rooms of a body that a text names

std::uint32_t known(const Structure& structure, const std::string& name) {
  const std::uint32_t body = structure.find(name);
  if (body == Structure::kNone) throw Refusal(Code::unknown_id, noSuchBody(name, structure.bodies));
  return body;
}

/// Builds the text of an explanation from its other fields.
class Words {
 public:
  /// @param near  whether the boxes of the two bodies are within the margin
  Words(const Snapshot& snapshot, const Explanation& what, bool near, const OptionNames& options)
      : what_(what),
        a_(snapshot.structure().bodies[what.first]),
        b_(snapshot.structure().bodies[what.second]),
        rooms_(snapshot.rooms()),
        near_(near),
        options_(options) {}

  std::string all() const {
    const std::string pair = a_.name + " and " + b_.name;
    const bool off = what_.rule.origin != Origin::none && what_.rule.allowed;
    std::string result;
    if (what_.reported) {
      result = pair + " are reported: " + nearness() + "." + enabled();
    } else if (off) {
      result = pair + " are not reported: " + switchedOff() + "." + (what_.separate ? alsoSeparate() : without());
    } else if (what_.separate) {
      result = pair + " are not reported: " + noCommonRoom() + "." + without() + enabled();
    } else if (what_.cut) {
      result = pair + " are not reported, although " + nearness() + ": there are more pairs than " +
               options_.max_pairs + " allows. " +
               "Of the pairs that were found, those with the smallest gaps are reported; of equal gaps, the first by "
               "name." +
               enabled();
    } else {
      result = pair + " are not reported: " + (hasBoxes() ? nearness() : missing()) + "." + enabled();
    }
    result += grown() + freshness(a_, what_.state_first, what_.age_first);
    if (what_.first != what_.second) result += freshness(b_, what_.state_second, what_.age_second);
    result += measured() + unread(a_);
    return what_.first == what_.second ? result : result + unread(b_);
  }

 private:
  /// Returns whether a body consists of cells only, or of planes only. The gap of two such bodies is never computed.
  static bool hasOnlyCellsOrPlanes(const Body& body) {
    const auto is_plane = [](const BodyShape& shape) { return shape.shape.kind() == ShapeKind::plane; };
    return hasCells(body.kind) ||
           (!body.shapes.empty() && std::all_of(body.shapes.begin(), body.shapes.end(), is_plane));
  }
  bool hasBoxes() const { return !std::isnan(what_.gap); }

  std::string nearness() const {
    const std::string margin = "the margin of " + metersText(what_.margin);
    if (!(what_.gap > 0.0)) return "their boxes touch or overlap, which is within " + margin;
    const std::string soon = what_.reported && !near_
                                 ? std::string(", but given their maximum speeds they can meet within ") +
                                       options_.horizon + ", or they passed each other since the previous tick"
                                 : "";
    return "their boxes are " + metersText(what_.gap) + " apart, " + (near_ ? "within " : "more than ") + margin + soon;
  }

  /// Returns a sentence about the shapes of a body that could not be read; empty if all shapes were read.
  static std::string unread(const Body& body) {
    if (body.covered || body.shapes.empty()) return {};
    return " Not all shapes of " + body.name + " could be read, so it may be nearer: " + body.note + ".";
  }

  /// Returns a text that says why the pair has no gap.
  std::string missing() const {
    for (const auto* body : {&a_, &b_}) {
      const Freshness state = body == &a_ ? what_.state_first : what_.state_second;
      if (state == Freshness::unplaced) {
        return body->name + " is UNPLACED: it never had a pose (frame '" + printable(body->frame) + "')";
      }
    }
    for (const auto* body : {&a_, &b_}) {
      if (hasCells(body->kind) || !body->shapes.empty()) continue;
      return body->name + " has no shape that could be read" + (body->note.empty() ? "" : ": " + body->note);
    }
    return (hasCells(a_.kind) ? a_ : b_).name + " has no occupied cells";
  }

  std::string switchedOff() const {
    const PairRule& rule = what_.rule;
    switch (rule.origin) {
      case Origin::self:
        return "they are the same body, and a body makes no pair with itself";
      case Origin::kind:
        return kind();
      case Origin::rigid:
        return "both links are of one rigid group, so they never move relative to each other";
      case Origin::adjacent:
        return "the links are adjacent: " + what_.rule.reason;
      case Origin::srdf:
        return "the SRDF disables the pair" + because();
      case Origin::group:
        return "both belong to the group '" + printable(a_.group) + "', and obstacles of one group make no pairs";
      case Origin::attached:
        return what_.rule.first + " may touch '" + printable(what_.rule.second) + "' because " + what_.rule.reason;
      default:
        return theRule("rule") + " allows them to touch" + because();
    }
  }

  std::string because() const {
    return what_.rule.reason.empty() || what_.rule.origin == Origin::moveit
               ? ""
               : " (" + printable(what_.rule.reason, kLongestRuleText) + ")";
  }

  std::string kind() const {
    if (a_.mobility == Mobility::fixed && b_.mobility == Mobility::fixed) {
      return "both are fixed in the world, and bodies that never move make no pair";
    }
    const bool links = a_.kind == BodyKind::link && b_.kind == BodyKind::link;
    const bool link = a_.kind == BodyKind::link || b_.kind == BodyKind::link;
    const bool map = hasCells(a_.kind) || hasCells(b_.kind);
    const auto moving_obstacle = [](const Body& body) {
      return countsAsObstacle(body.kind) && body.mobility == Mobility::moving;
    };
    if (!link && !moving_obstacle(a_) && !moving_obstacle(b_)) {
      return "a pair needs a link of a robot or an obstacle that moves, and neither body is one";
    }
    const char* name = links  ? (a_.robot == b_.robot ? "self" : "robot_robot")
                       : link ? (map ? "robot_map" : "robot_obstacle")
                              : "moving_obstacle";
    return std::string(options_.pair_kinds) + " does not contain their kind of pair, " + name +
           ", and no rule can change that";
  }

  /// Returns a text that names the rooms of a body: "a is in 'hall', 'cell'".
  std::string roomsOf(const Body& body, std::uint32_t number) const {
    const std::vector<std::uint32_t> rooms = rooms_->roomsOf(number);
    std::string words = body.name + " is in ";
    for (std::size_t i = 0; i < std::min(rooms.size(), kMostRooms); ++i) {
      words += (i > 0 ? ", '" : "'") + printable(rooms_->building().rooms()[rooms[i]].name, 48) + "'";
    }
    return rooms.size() > kMostRooms ? words + " and " + std::to_string(rooms.size() - kMostRooms) + " more" : words;
  }

  std::string noCommonRoom() const {
    return "they have no room of " + std::string(options_.rooms) +
           " in common, so they are never a pair: " + roomsOf(a_, what_.first) + ", and " + roomsOf(b_, what_.second);
  }
  std::string alsoSeparate() const { return " Also, " + noCommonRoom() + "."; }

  std::string theRule(const std::string& begin) const {
    const PairRule& rule = what_.rule;
    std::string words = begin + " '" + printable(rule.first) + "', '" + printable(rule.second) + "' of ";
    words += rule.origin == Origin::service  ? options_.added_rules
             : rule.origin == Origin::moveit ? "MoveIt's allowed collision matrix"
                                             : options_.allowed_pairs;
    if (rule.ends != PairRule::Clock::time_point::max()) {
      const double left = std::chrono::duration<double>(rule.ends - PairRule::Clock::now()).count();
      words += ", which ends in " + secondsText(std::max(0.0, left)) + ",";
    }
    return words;
  }

  /// Returns a sentence that says whether the pair would be reported if no rule and no wall prevented it.
  std::string without() const {
    if (what_.rule.origin == Origin::self) return {};
    if (hasOnlyCellsOrPlanes(a_) && hasOnlyCellsOrPlanes(b_)) return {};
    if (!hasBoxes()) return " Also, " + missing() + ".";
    return near_ ? " Otherwise they would be reported: " + nearness() + "." : " Also, " + nearness() + ".";
  }

  /// Returns a sentence that names the rule or SRDF that says "report this pair"; empty if there is none.
  std::string enabled() const {
    const PairRule& rule = what_.rule;
    if (rule.origin == Origin::none) return {};
    const std::string who = rule.origin == Origin::srdf ? "The SRDF's enable_collisions" : theRule("Rule");
    return " " + who + " does not allow them to touch" + because() + ".";
  }

  std::string grown() const {
    if (!(what_.growth > 0.0) || !hasBoxes()) return {};
    return " The margin is " + metersText(what_.growth) + " larger than usual because data is old or comes rarely.";
  }

  static std::string freshness(const Body& body, Freshness state, double age) {
    if (state == Freshness::fresh || state == Freshness::unplaced) return {};
    return " " + body.name + " is " + name(state) + ": " + causeOf(state) + "its pose is " + secondsText(age) + " old.";
  }

  std::string measured() const {
    switch (what_.measured) {
      case Measure::not_measured:
        return {};
      case Measure::apart:
        return std::isinf(what_.distance)
                   ? " Their shapes are farther apart than the distance up to which they were measured."
                   : " Their shapes are " + metersText(what_.distance) + " apart.";
      case Measure::contact:
        return " Their shapes are in contact.";
      case Measure::contained:
        return " One shape lies inside the other, which counts as contact.";
      case Measure::containment_unknown:
        return " One shape may lie inside the other, a mesh that is open or unclear; this counts as contact.";
      case Measure::failed:
        break;
    }
    return " Their distance could not be computed; this counts as contact.";
  }

  const Explanation& what_;
  const Body &a_, &b_;
  const BodyRooms* rooms_;  // null: there are no rooms
  bool near_;
  const OptionNames& options_;
};

/// Sets the gap of the pair and returns whether it is within the margin. If the pair is reported, copies its values
/// from the snapshot.
bool fillGap(const Snapshot& snapshot, Explanation& what) {
  const Structure& s = snapshot.structure();
  const auto key = std::minmax(what.first, what.second);
  const std::vector<NearPair>& pairs = snapshot.pairs();
  const auto found = std::lower_bound(pairs.begin(), pairs.end(), key, [](const NearPair& pair, const auto& wanted) {
    return pair.first != wanted.first ? pair.first < wanted.first : pair.second < wanted.second;
  });
  if (found != pairs.end() && found->first == key.first && found->second == key.second) {
    what.reported = true;
    what.position = static_cast<std::size_t>(found - pairs.begin());
    what.gap = found->gap;
    what.margin = found->margin;
    what.since = found->since;
    return (found->flags & kHorizonFlag) == 0;
  }
  what.gap = kNan;
  if (what.state_first == Freshness::unplaced || what.state_second == Freshness::unplaced) return false;
  const double gap = snapshot.gapOf(what.first, what.second);
  if (!std::isfinite(gap)) return false;
  what.gap = gap;
  bool near = gap <= what.margin && (s.isMap(what.first) || s.isMap(what.second));
  for (std::uint32_t i = s.first_proxy[what.first]; i < s.first_proxy[what.first + 1]; ++i) {
    for (std::uint32_t j = s.first_proxy[what.second]; j < s.first_proxy[what.second + 1]; ++j) {
      near = near || snapshot.areWithin(i, j, what.margin);
    }
  }
  if (near) what.gap = std::min(what.gap, what.margin);  // Snapshot::pairs() limits gaps in the same way
  return near;
}

}  // namespace

Explanation explain(const Snapshot& snapshot, const std::string& first, const std::string& second,
                    const PairDistance* exact, const OptionNames& options) {
  const DefaultFloatEnvironment environment;
  const Structure& structure = snapshot.structure();
  Explanation what;
  what.first = known(structure, first);
  what.second = known(structure, second);
  what.rule = decidedRule(structure, what.first, what.second);
  const BodyPose &a = snapshot.poses()[what.first], &b = snapshot.poses()[what.second];
  what.state_first = a.state;
  what.state_second = b.state;
  what.age_first = a.state == Freshness::unplaced ? kNan : a.age;
  what.age_second = b.state == Freshness::unplaced ? kNan : b.age;
  what.margin_pair = structure.pair_margins.of(what.first, what.second).value_or(Proximity::kUnknown);
  what.margin_first = structure.margin[what.first];
  what.margin_second = structure.margin[what.second];
  what.growth = snapshot.growthOf(what.first, what.second);
  what.margin = snapshot.marginOf(what.first, what.second) + what.growth;
  what.distance = kNan;
  if (exact != nullptr) {
    what.measured = exact->proximity.status;
    what.distance = exact->proximity.distance;
  }
  const bool near = fillGap(snapshot, what);
  what.separate = what.first != what.second && snapshot.areSeparate(what.first, what.second);
  what.cut = near && !what.reported && !what.rule.allowed && !what.separate && snapshot.truncated();
  what.text = Words(snapshot, what, near, options).all();
  return what;
}

}  // namespace hgrid
