// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/edge_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/rotation.h"
#include "geometry/rounding.h"
#include "queries/states/four_boxes.h"

namespace hgrid {
namespace {

// [m] Least slack: shapes that are nearer than this are not told apart on an edge. It is the least tolerance of a
// request, so it leaves nothing unknown that could be decided.
constexpr double kLeastSlack = 1e-6;
constexpr double kMoreThanHalf = 1.0 + 1e-6;  // makes up for the rounding of halves and of sums in floats
constexpr double kFirstPart = 0.1;            // [m] no point of the robot travels farther on the first part of an edge
constexpr double kProbe =
    0.1;  // [m] with EdgeRequest::any_contact, one configuration is tested per this length of path
constexpr double kMostProbes = 64;   // upper limit of the number of tested configurations
constexpr float kCoarse = 0.02f;     // [m] shapes are not measured while they can travel farther than this
constexpr std::size_t kFewNear = 8;  // if more shapes are near in the middle of a part, the next parts are shorter
constexpr double kNowhere = 2.0;     // a place behind the end of an edge
constexpr float kTooFar = -std::numeric_limits<float>::infinity();  // reach of shapes that cannot meet
constexpr double kSameWay = 1e-6;    // [rad] if two ways around the circle differ by less than twice this, both count
constexpr double kShortest = 1e-12;  // parts of an edge that are this short are not divided

/// Interpolates between two unit quaternions at constant speed, along the way on which `difference` leads.
Eigen::Vector4d turned(const Eigen::Vector4d& from, const Eigen::Vector4d& difference, double at) {
  const Eigen::Vector4d begin = from.normalized(), end = (from + difference).normalized();
  return between(Eigen::Quaterniond(begin), Eigen::Quaterniond(end), at).coeffs();
}

/// Adds the slack to a reach [m]. Shapes that do not move against each other have none: one state decides.
float withSlack(const EdgeInWork& work, float reach) { return reach > 0.0f ? reach + work.slack : 0.0f; }

/// Returns the place on the edge of a configuration that is tested for contact. They are spread evenly: 1, 1/2, 1/4,
/// 3/4, 1/8 and so on (the van der Corput sequence). @param number  1, 2 ...
double probedPlace(std::uint32_t number) {
  if (number == 1) return 1.0;
  double place = 0.0, digit = 0.5;
  for (std::uint32_t rest = number - 1; rest > 0; rest /= 2, digit *= 0.5) place += rest % 2 * digit;
  return place;
}

}  // namespace

EdgeSearch::EdgeSearch(const CheckerParts& all, const StateBatch& batch, const std::vector<StateEdge>& edges,
                       const EdgeRequest& request, StateMemory& memory, EdgeAnswers& answers)
    : all_(all),
      batch_(batch),
      edges_(edges),
      request_(request),
      memory_(memory),
      answers_(answers),
      values_(all.kinematics, all.robot, batch, memory),
      search_(*all.snapshot, *all.narrow_phase, all.robot, all.world, SearchGoal::all_near,
              std::numeric_limits<double>::infinity(), false, memory),
      doubt_(all.doubts.findAnywhere(!batch.world_from_root)) {
  memory.prepare(all.kinematics, all.robot);
}

void EdgeSearch::run() {
  const Pose world_from_root = all_.worldFromRoot(batch_);
  root_rounding_ = gapRounding(world_from_root.translation().norm());
  answers_.edges.assign(edges_.size(), EdgeAnswer{});
  answers_.pairs.clear();
  for (std::size_t lane = 0; lane < 4; ++lane) {
    values_.clear(lane);
    begin(lane);
  }
  for (bool is_first = true;; is_first = false) {
    const bool in_time = !request_.deadline || std::chrono::steady_clock::now() < *request_.deadline;
    if (!in_time) return finishAll();
    unsigned open = 0, all = 0;
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if (!memory_.edges[lane].active) continue;
      place(lane);
      open |= 1u << lane;
      if (memory_.edges[lane].searches_all) all |= 1u << lane;
    }
    if (open == 0) return;
    forwardKinematics(all_.kinematics, memory_.values, world_from_root, is_first ? nullptr : memory_.changes.data(),
                      memory_.groups);
    search_.place(open, is_first);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if ((open >> lane & 1u) != 0) findReaches(lane);
    }
    findPairReaches(all);
    search_.findAll(all);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if ((open >> lane & 1u) == 0) continue;
      const EdgeInWork& work = memory_.edges[lane];
      const NearShapes* const candidates = work.candidates.data() + work.part.first;
      if (!work.searches_all) search_.findAmong(lane, candidates, candidates + work.part.count);
      use(lane);
    }
  }
}

/// Ends the search, because the deadline has passed.
void EdgeSearch::finishAll() {
  for (std::size_t lane = 0; lane < 4; ++lane) {
    if (memory_.edges[lane].active) finish(lane, false);
  }
  for (; next_ < edges_.size(); ++next_) {
    if (read(next_, 0)) answers_.edges[next_].because = Unknown::budget;
  }
}

/// Gives a lane the next edge that can be examined. Returns whether there is one.
bool EdgeSearch::begin(std::size_t lane) {
  EdgeInWork& work = memory_.edges[lane];
  work.active = false;
  while (next_ < edges_.size()) {
    const std::size_t edge = next_++;
    if (!read(edge, lane)) continue;
    work.edge = edge;
    work.active = true;
    work.begin = 0.0;
    work.end = 1.0;
    work.uncertain_from = kNowhere;
    work.probed = 0;
    work.contact.reset();
    work.near.reset();
    work.doubt.reset();
    work.parts.clear();
    work.path = all_.motion.find(memory_.from, memory_.values, memory_.difference, lane, work.motion);
    work.slack = roundedUp(std::max(kLeastSlack, root_rounding_ + work.motion.rounding));
    work.probes = request_.any_contact ? static_cast<std::uint32_t>(std::min(work.path / kProbe, kMostProbes)) : 0;
    work.step = work.path > kFirstPart ? kFirstPart / work.path : 1.0;
    return true;
  }
  return false;
}

/// Reads both ends of an edge. Returns false if the edge is refused, or if its way is not known.
bool EdgeSearch::read(std::size_t edge, std::size_t lane) {
  values_.restoreOthers(lane);  // place() writes all variables, also the rest of a quaternion of which a part is given
  if (!readEnd(edge, edges_[edge].from, lane)) return false;
  for (std::size_t i = 0; i < memory_.values.size(); ++i) memory_.from[i].set(lane, memory_.values[i][lane]);
  if (!readEnd(edge, edges_[edge].to, lane)) return false;
  const std::vector<JointVariable>& variables = all_.kinematics.variables();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double from = memory_.from[i][lane], to = memory_.values[i][lane];
    memory_.difference[i].set(lane, all_.wraps[i] ? std::remainder(to - from, 2.0 * M_PI) : to - from);
    if (all_.wraps[i] && std::abs(memory_.difference[i][lane]) >= M_PI - kSameWay) return turnsHalf(edge, i);
    if (variables[i].quaternion < 0 || variables[i].quaternion + 3 != static_cast<int>(i)) continue;
    double cosine = 0.0;
    for (std::size_t k = i - 3; k <= i; ++k) cosine += memory_.from[k][lane] * memory_.values[k][lane];
    if (std::abs(cosine) <= 0.5 * kSameWay) return turnsHalf(edge, i);
    if (cosine >= 0.0) continue;  // otherwise the way to the opposite quaternion is shorter; it is the same rotation
    for (std::size_t k = i - 3; k <= i; ++k) {
      memory_.difference[k].set(lane, -memory_.values[k][lane] - memory_.from[k][lane]);
    }
  }
  return true;
}

/// Notes that a variable turns by half a turn on an edge. A controller may take either way. Returns false.
bool EdgeSearch::turnsHalf(std::size_t edge, std::size_t variable) {
  answers_.edges[edge].because = Unknown::half_turn;
  answers_.edges[edge].detail = static_cast<std::uint32_t>(variable);
  return false;
}

/// Reads the state at one end of an edge. Returns false if the edge is refused because of it.
bool EdgeSearch::readEnd(std::size_t edge, std::uint32_t state, std::size_t lane) {
  EdgeAnswer& answer = answers_.edges[edge];
  StateAnswer read;
  if (state >= values_.size()) {
    answer.refused = Code::out_of_range;
  } else {
    values_.read(state, lane, read);
    answer.refused = read.refused;
    answer.beyond_limits = answer.beyond_limits || read.beyond_limits;
  }
  if (answer.refused == Code::ok) return true;
  answer.because = Unknown::refused;
  answer.detail = read.detail;
  answer.refused_state = state;
  return false;
}

/// Chooses the part that is examined next.
void EdgeSearch::choosePart(EdgeInWork& work) const {
  work.searches_all = work.parts.empty();
  if (work.probed < work.probes) {
    const double at = probedPlace(work.probed + 1);
    work.part = {at, at};
  } else if (work.searches_all) {
    work.part = {work.begin, std::min(work.end, work.begin + work.step)};
    work.candidates.clear();
  } else {
    work.part = work.parts.back();
    work.parts.pop_back();
    work.part.tip = std::min(work.part.tip, work.end);
    work.candidates.resize(work.part.first + work.part.count);  // those behind belong to parts that are finished
  }
}

/// Places the robot in the middle of the next part.
void EdgeSearch::place(std::size_t lane) {
  EdgeInWork& work = memory_.edges[lane];
  choosePart(work);
  const double at = 0.5 * (work.part.begin + work.part.tip), half = 0.5 * (work.part.tip - work.part.begin);
  memory_.coarse[lane] = isShort(work, 2.0 * half) ? std::numeric_limits<float>::infinity() : kCoarse;
  const std::vector<JointVariable>& variables = all_.kinematics.variables();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (variables[i].quaternion == static_cast<int>(i)) {
      Eigen::Vector4d from, difference;
      for (std::size_t k = 0; k < 4; ++k) {
        from[static_cast<Eigen::Index>(k)] = memory_.from[i + k][lane];
        difference[static_cast<Eigen::Index>(k)] = memory_.difference[i + k][lane];
      }
      const Eigen::Vector4d turn = turned(from, difference, at);
      for (std::size_t k = 0; k < 4; ++k) memory_.values[i + k].set(lane, turn[static_cast<Eigen::Index>(k)]);
    } else if (variables[i].quaternion < 0) {
      memory_.values[i].set(lane, memory_.from[i][lane] + at * memory_.difference[i][lane]);
    }
  }
}

/// Finds how near to each other shapes must be in the middle of a part to matter. If all shapes are searched,
/// findPairReaches() does this for the pairs of shapes of the robot.
void EdgeSearch::findReaches(std::size_t lane) {
  EdgeInWork& work = memory_.edges[lane];
  const MotionBounds::HalfPart half{memory_.groups.in_world, memory_.placed, all_.snapshot->origin(), lane,
                                    0.5 * (work.part.tip - work.part.begin) * kMoreThanHalf};
  if (work.searches_all) {
    for (std::size_t i = 0; i < memory_.shape_reach.size(); ++i) {
      all_.motion.findPart(i, half, work.motion);
      memory_.shape_reach[i][lane] = withSlack(work, all_.motion.reachOf(i, work.motion));
    }
    return;
  }
  for (std::size_t i = work.part.first; i < work.part.first + work.part.count; ++i) {
    const NearShapes& near = work.candidates[i];
    all_.motion.findPart(near.own, half, work.motion);
    if (near.with == With::self) {
      all_.motion.findPart(near.other, half, work.motion);
      memory_.pair_reach[near.pair][lane] = withSlack(work, all_.motion.reachOfPair(near.pair, work.motion));
    } else {
      memory_.shape_reach[near.own][lane] = withSlack(work, all_.motion.reachOf(near.own, work.motion));
    }
  }
}

/// Finds how near to each other the shapes of each pair must be to matter. Their relative travel is at most the sum of
/// both travels, so pairs and blocks that are farther apart than this sum are skipped.
/// @param lanes  the lanes in which all shapes are searched
void EdgeSearch::findPairReaches(unsigned lanes) {
  if (lanes == 0) return;
  const auto sum = [](const Four& a, const Four& b) { return (a + b) * static_cast<float>(kMoreThanHalf); };
  const auto set = [lanes](Four& reach, unsigned near, const auto& reachIn) {
    for (std::size_t lane = 0; lane < 4; ++lane) {
      if ((lanes >> lane & 1u) != 0) reach[lane] = (near >> lane & 1u) != 0 ? reachIn(lane) : kTooFar;
    }
  };
  const std::vector<SelfPair>& pairs = all_.robot.selfPairs();
  for (std::size_t k = 0; k < all_.robot.selfBlocks().size(); ++k) {
    const SelfBlock& block = all_.robot.selfBlocks()[k];
    if (block.isOfClusters()) {
      const Four most = sum(reachOfCluster(block.first_cluster), reachOfCluster(block.second_cluster));
      const unsigned near =
          overlapping(memory_.clusters[block.first_cluster], memory_.clusters[block.second_cluster], most) & lanes;
      set(memory_.block_reach[k], near, [&](std::size_t lane) { return most[lane]; });
      if (near == 0) continue;
    }
    for (std::size_t i = block.first; i < block.last; ++i) {
      const SelfPair& pair = pairs[i];
      const Four most = sum(memory_.shape_reach[pair.first], memory_.shape_reach[pair.second]);
      const unsigned near = overlapping(memory_.placed[pair.first].bounds, memory_.placed[pair.second].bounds, most);
      set(memory_.pair_reach[i], near, [&](std::size_t lane) {
        const EdgeInWork& work = memory_.edges[lane];
        return withSlack(work, all_.motion.reachOfPair(i, work.motion));
      });
    }
  }
}

/// Returns the greatest reach of the shapes of a cluster. @param cluster  index into RobotShapes::clusters()
Four EdgeSearch::reachOfCluster(std::size_t cluster) const {
  const ShapeCluster& shapes = all_.robot.clusters()[cluster];
  Four reach = memory_.shape_reach[shapes.first];
  for (std::uint32_t i = shapes.first + 1; i < shapes.last; ++i) reach = greatest(reach, memory_.shape_reach[i]);
  return reach;
}

/// Returns whether a part of this length is not divided any more.
bool EdgeSearch::isShort(const EdgeInWork& work, double length) const {
  return length * work.path <= 0.5 * request_.tolerance || length <= kShortest;
}

/// Uses what the search found in the middle of a part.
void EdgeSearch::use(std::size_t lane) {
  EdgeInWork& work = memory_.edges[lane];
  const double length = work.part.tip - work.part.begin;
  if (!search_.contacts(lane).empty()) {
    useContact(work, search_.contacts(lane).front(), search_.touching(lane));
  } else if (work.probed < work.probes) {
    ++work.probed;
  } else {
    std::optional<std::uint32_t> doubt;
    const bool matters = !doubt_ && work.uncertain_from == kNowhere;  // otherwise the edge cannot become clear
    if (matters && !all_.doubts.none() && (work.searches_all || work.part.in_doubt)) {
      doubt = all_.doubts.findNear(search_.robotIn(lane), 0.5 * length * work.path + static_cast<double>(work.slack));
    }
    if (search_.kept(lane).empty() && !doubt) {
      work.begin = work.part.tip;
      if (work.searches_all) work.step = 2.0 * length;
    } else {
      divide(work, lane, doubt);
    }
  }
  if (!isDone(work)) return;
  finish(lane, true);
  begin(lane);
}

/// Returns whether nothing of an edge is left to be examined. Drops the parts behind a contact.
bool EdgeSearch::isDone(EdgeInWork& work) const {
  if (work.contact && request_.any_contact) return true;
  while (work.contact && !work.parts.empty() && work.parts.back().begin >= work.end) work.parts.pop_back();
  const double rest = work.end - work.begin;
  return (rest <= 0.0 && work.parts.empty()) || (work.contact && isShort(work, rest));
}

/// Uses a contact in the middle of a part. What comes before it is examined next.
void EdgeSearch::useContact(EdgeInWork& work, const StatePair& contact, const TouchingSolids& touching) const {
  EdgePart& part = work.part;
  work.contact = contact;
  work.touching = touching;
  work.end = work.path > 0.0 ? 0.5 * (part.begin + part.tip) : part.begin;
  if (work.searches_all) {
    work.step = 0.5 * (work.end - work.begin);
  } else {
    work.parts.push_back({part.begin, work.end, part.first, part.count, part.in_doubt});
  }
}

/// Stores what the search found near, as candidates of further parts.
EdgePart EdgeSearch::keep(EdgeInWork& work, std::size_t lane, bool in_doubt) const {
  const std::vector<NearShapes>& kept = search_.kept(lane);
  const EdgePart part{0.0, 0.0, work.candidates.size(), kept.size(), in_doubt};
  work.candidates.insert(work.candidates.end(), kept.begin(), kept.end());
  return part;
}

/// Divides a part that may have a contact, or leaves it if it is already short.
void EdgeSearch::divide(EdgeInWork& work, std::size_t lane, std::optional<std::uint32_t> doubt) const {
  const EdgePart part = work.part;
  const double length = part.tip - part.begin;
  if (isShort(work, length)) {
    if (work.uncertain_from == kNowhere) {
      work.uncertain_from = part.begin;
      work.doubt = doubt;
      if (!doubt) work.near = search_.nearPair(lane);
    }
    work.begin = part.tip;
    if (work.searches_all) work.step = 2.0 * length;
    if (length == 0.0) return;
    const EdgePart rest = keep(work, lane, false);  // an end of the edge may be in contact
    if (part.tip == 1.0) work.parts.push_back({1.0, 1.0, rest.first, rest.count, false});
    if (part.begin == 0.0) work.parts.push_back({0.0, 0.0, rest.first, rest.count, false});
    return;
  }
  const std::vector<NearShapes>& kept = search_.kept(lane);
  const double middle = 0.5 * (part.begin + part.tip);
  const EdgePart half = keep(work, lane, doubt.has_value());
  work.parts.push_back({middle, part.tip, half.first, half.count, half.in_doubt});
  work.parts.push_back({part.begin, middle, half.first, half.count, half.in_doubt});
  if (!work.searches_all) return;
  work.step = kept.size() <= kFewNear ? length : 0.5 * length;
}

/// Writes the answer for the edge of a lane.
void EdgeSearch::finish(std::size_t lane, bool in_time) {
  EdgeInWork& work = memory_.edges[lane];
  EdgeAnswer& answer = answers_.edges[work.edge];
  work.active = false;
  answer.first_pair = static_cast<std::uint32_t>(answers_.pairs.size());
  answer.free_until = doubt_ ? 0.0 : std::min(work.begin, work.uncertain_from);
  if (work.contact) {
    answer.verdict = Verdict::hit;
    answer.at = work.end;
    answers_.pairs.push_back(*work.contact);
    if (request_.contacts) {  // only now, because the search may find several contacts on an edge
      answers_.pairs.back().contact = work.touching.measure(*all_.narrow_phase, work.contact->proximity.status);
    }
  } else if (!in_time) {
    answer.because = Unknown::budget;
  } else if (doubt_ || work.doubt) {
    answer.detail = doubt_ ? *doubt_ : *work.doubt;
    answer.because = all_.doubts[answer.detail].because;
  } else if (work.near) {
    answer.because = Unknown::tolerance;
    answers_.pairs.push_back(*work.near);
  } else {
    answer.verdict = Verdict::clear;
  }
  answer.pairs = static_cast<std::uint32_t>(answers_.pairs.size()) - answer.first_pair;
}

}  // namespace hgrid
