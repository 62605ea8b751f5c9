// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/distances/pair_meter.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <tuple>

#include "bodies/motion_bound.h"
#include "broadphase/workers.h"
#include "distances/map_meter.h"
#include "hgrid_proximity/geometry/float_environment.h"

namespace hgrid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLittle = 0.25;         // a smaller move than this share of the report distance is a small one
constexpr double kSmoothing = 0.05;      // [s] time constant of the low-pass filter for the closing speed
constexpr std::size_t kPairsPerJob = 8;  // pairs that a thread measures before it takes the next job

struct ShapePair {
  double gap;
  std::uint32_t first, second;
};

/// The nearest shapes of two bodies, and how they lie relative to each other.
struct NearestShapes {
  std::uint32_t first = 0, second = 0;
  Proximity proximity;
  std::vector<NearCell> cells;  // nearest cells, if one of the bodies is a map
};

/// Collects the pairs of shapes whose boxes are at most `up_to` [m] apart, nearest boxes first.
void collectShapePairs(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second, double up_to,
                       std::vector<ShapePair>& shape_pairs) {
  const std::vector<ProxyId>& begin = snapshot.structure().first_proxy;
  shape_pairs.clear();
  for (ProxyId a = begin[first]; a < begin[first + 1]; ++a) {
    for (ProxyId b = begin[second]; b < begin[second + 1]; ++b) {
      const double gap = distance(snapshot.boxes()[a], snapshot.boxes()[b]);
      if (gap <= up_to) shape_pairs.push_back({gap, a - begin[first], b - begin[second]});
    }
  }
  std::sort(shape_pairs.begin(), shape_pairs.end(), [](const ShapePair& a, const ShapePair& b) {
    return std::tie(a.gap, a.first, a.second) < std::tie(b.gap, b.first, b.second);
  });
}

/// Calls `ask` with a pair of shapes as solids at their poses. Does nothing if one of the shapes has no solid.
template <class Ask>
void placed(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second, const ShapePair& shapes, Ask&& ask) {
  const std::vector<Body>& bodies = snapshot.structure().bodies;
  const BodyShape &a = bodies[first].shapes[shapes.first], &b = bodies[second].shapes[shapes.second];
  if (!a.solid || !b.solid) return;
  const Pose world_from_a = snapshot.poses()[first].world_from_body * a.body_from_shape;
  const Pose world_from_b = snapshot.poses()[second].world_from_body * b.body_from_shape;
  ask(PlacedSolid{*a.solid, world_from_a, a.padding}, PlacedSolid{*b.solid, world_from_b, b.padding});
}

NearestShapes nearestShapes(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                            std::uint32_t second, double up_to, std::vector<ShapePair>& shape_pairs) {
  NearestShapes nearest;
  if (snapshot.structure().isMap(first) || snapshot.structure().isMap(second)) {
    MapProximity found = measureMap(narrow_phase, snapshot, first, second, up_to);
    (snapshot.structure().isMap(first) ? nearest.second : nearest.first) = found.shape;
    nearest.proximity = found.proximity;
    nearest.cells = std::move(found.cells);
    return nearest;
  }
  const std::vector<Body>& bodies = snapshot.structure().bodies;
  if (bodies[first].shapes.empty() || bodies[second].shapes.empty()) return nearest;  // nothing to measure
  collectShapePairs(snapshot, first, second, up_to, shape_pairs);
  nearest.proximity.status = Measure::apart;
  nearest.proximity.distance = std::numeric_limits<double>::infinity();
  double least = up_to;
  for (const ShapePair& shapes : shape_pairs) {
    if (shapes.gap > least) break;
    Proximity found;
    placed(snapshot, first, second, shapes,
           [&](const PlacedSolid& a, const PlacedSolid& b) { found = narrow_phase.measure(a, b, least); });
    if (found.status == Measure::not_measured || found.distance < nearest.proximity.distance) {
      nearest = {shapes.first, shapes.second, found, {}};
    }
    if (found.status != Measure::apart) break;  // no other pair of shapes can be nearer
    least = std::min(least, found.distance);
  }
  return nearest;
}

}  // namespace

PairDistance measurePair(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                         std::uint32_t second, double up_to) {
  const DefaultFloatEnvironment environment;
  std::vector<ShapePair> shape_pairs;
  const NearestShapes nearest = nearestShapes(narrow_phase, snapshot, first, second, up_to, shape_pairs);
  PairDistance result;
  result.first = first;
  result.second = second;
  result.first_shape = nearest.first;
  result.second_shape = nearest.second;
  result.proximity = nearest.proximity;
  result.cells = nearest.cells;
  return result;
}

std::vector<PairContact> contactsOf(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                    std::uint32_t second, std::size_t most) {
  const DefaultFloatEnvironment environment;
  std::vector<PairContact> contacts;
  std::vector<ShapePair> shape_pairs;
  if (snapshot.structure().isMap(first) || snapshot.structure().isMap(second)) {
    contacts = contactsWithMap(narrow_phase, snapshot, first, second, most);
  } else {
    collectShapePairs(snapshot, first, second, 0.0, shape_pairs);
  }
  for (const ShapePair& shapes : shape_pairs) {
    placed(snapshot, first, second, shapes, [&](const PlacedSolid& a, const PlacedSolid& b) {
      for (const Contact& contact : narrow_phase.contacts(a, b, most - contacts.size())) {
        contacts.push_back({shapes.first, shapes.second, contact});
      }
    });
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const PairContact& a, const PairContact& b) { return deeper(a.contact, b.contact); });
  return contacts;
}

struct PairMeter::State {
  /// The result of the last measurement of a pair.
  struct Known {
    std::uint32_t first = 0, second = 0;
    bool measured = false;  // whether the pair was ever measured; if not, the other members are meaningless
    Time measured_at{0};    // stamp of the snapshot for which this result is valid
    Pose world_from_first = Pose::Identity(), world_from_second = Pose::Identity();
    std::uint32_t first_shape = 0, second_shape = 0;
    Proximity proximity;
    std::vector<NearCell> cells;
    std::shared_ptr<const MapCells> map;  // the cells of the map at the measurement; null without a map
    double up_to = 0.0;                   // [m] the search ended at this distance
    // The last sample of the distance, for the closing speed.
    Time stamp{0};
    double distance = Proximity::kUnknown, speed = Proximity::kUnknown;
  };
  struct Job {
    const NearPair* pair;
    double report;         // [m] a pair that is farther apart is not listed
    Known known;           // input: the last result; output: the new result
    bool shown, left_out;  // shown: the pair is listed; left_out: the time ran out before it was measured
  };

  State(std::shared_ptr<const NarrowPhase> phase, const MeterOptions& given)
      : narrow_phase(std::move(phase)), options(given), workers(given.threads) {}

  void recall(const Snapshot& snapshot);
  static std::shared_ptr<const MapCells> mapOf(const Snapshot& snapshot, const Known& known);
  static double motionSince(const Snapshot& snapshot, const Known& known);
  static double boundOf(const Snapshot& snapshot, const Known& known);
  void perform(const Snapshot& snapshot, Job& job, std::vector<ShapePair>& shape_pairs) const;
  PairDistance entryOf(const Snapshot& snapshot, const Job& job) const;

  std::shared_ptr<const NarrowPhase> narrow_phase;
  MeterOptions options;
  Workers workers;
  std::uint64_t revision = 0, epoch = 0;
  std::vector<Known> known;  // sorted by (first, second)
  std::vector<Job> jobs;
  std::vector<std::vector<ShapePair>> scratch;  // one buffer for each thread
};

PairMeter::PairMeter(std::shared_ptr<const NarrowPhase> narrow_phase, const MeterOptions& options)
    : state_(std::make_unique<State>(std::move(narrow_phase), options)) {}
PairMeter::~PairMeter() = default;

/// Creates the jobs, those with the smallest gap first. Each job gets the last result of its pair.
void PairMeter::State::recall(const Snapshot& snapshot) {
  const Structure& structure = snapshot.structure();
  if (revision != structure.revision || epoch != snapshot.epoch()) known.clear();  // the body indices may have changed
  revision = structure.revision;
  epoch = snapshot.epoch();
  jobs.clear();
  auto last = known.begin();
  for (const NearPair& pair : snapshot.pairs()) {
    // If margins grow because data is old, the report distance grows by the same length.
    const double report = options.report_distance + snapshot.growthOf(pair.first, pair.second);
    const auto before = [&](const Known& one) {
      return one.first != pair.first ? one.first < pair.first : one.second < pair.second;
    };
    while (last != known.end() && before(*last)) ++last;
    if (pair.gap > report) continue;
    jobs.push_back({&pair, report, {}, false, false});
    Known& now = jobs.back().known;
    if (last != known.end() && last->first == pair.first && last->second == pair.second) now = *last;
    now.first = pair.first;
    now.second = pair.second;
  }
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.pair->gap < b.pair->gap; });
}

/// Returns the cells of the map in a pair; null if neither body is a map.
std::shared_ptr<const MapCells> PairMeter::State::mapOf(const Snapshot& snapshot, const Known& known) {
  return snapshot.cellsOf(snapshot.structure().isMap(known.first) ? known.first : known.second);
}

/// Returns the largest change [m] of the distance of a pair that its motion since the last measurement allows. Infinite
/// if the pair was never measured or if the cells of its map have changed.
double PairMeter::State::motionSince(const Snapshot& snapshot, const Known& known) {
  const Structure& structure = snapshot.structure();
  const bool map_first = structure.isMap(known.first);
  const auto map = mapOf(snapshot, known);
  if (!known.measured || known.map != map) return std::numeric_limits<double>::infinity();
  const Pose &first = snapshot.poses()[known.first].world_from_body,
             &second = snapshot.poses()[known.second].world_from_body;
  if (first.matrix() == known.world_from_first.matrix() && second.matrix() == known.world_from_second.matrix())
    return 0.0;
  if (map_first || !map) {
    return relativeMotion(known.world_from_first, known.world_from_second, first, second,
                          reachOf(structure.bodies[known.second]));
  }
  return relativeMotion(known.world_from_second, known.world_from_first, second, first,
                        reachOf(structure.bodies[known.first]));
}

/// Returns a lower bound [m] of the distance of a pair that is not measured now: its last measured distance, minus what
/// both bodies have moved since. 0 if the pair was never measured.
double PairMeter::State::boundOf(const Snapshot& snapshot, const Known& known) {
  if (known.proximity.status == Measure::not_measured) return 0.0;
  return std::max(0.0, std::min(known.proximity.distance, known.up_to) - motionSince(snapshot, known));
}

void PairMeter::State::perform(const Snapshot& snapshot, Job& job, std::vector<ShapePair>& shape_pairs) const {
  const Pose &first = snapshot.poses()[job.pair->first].world_from_body,
             &second = snapshot.poses()[job.pair->second].world_from_body;
  Known& now = job.known;
  const double moved = motionSince(snapshot, now);
  const double at_least = std::min(now.proximity.distance, now.up_to) - moved;
  const bool enough_known = moved == 0.0 ? now.up_to >= job.report : at_least > job.report;
  if (!now.measured || !enough_known) {
    // The distance cannot exceed this bound, so the search may end there. The addend is larger than any solver error.
    const double at_most = now.proximity.distance + moved + 1e-6;
    // After a small move, search a little farther than the report distance, so that the next tick need not measure.
    now.up_to = moved < kLittle * job.report ? (1.0 + kLittle) * job.report : job.report;
    now.world_from_first = first;
    now.world_from_second = second;
    const NearestShapes nearest = nearestShapes(*narrow_phase, snapshot, job.pair->first, job.pair->second,
                                                at_most < now.up_to ? at_most : now.up_to, shape_pairs);
    now.first_shape = nearest.first;
    now.second_shape = nearest.second;
    now.proximity = nearest.proximity;
    now.cells = nearest.cells;
    now.map = mapOf(snapshot, now);
    now.measured = true;
  }
  if (moved == 0.0 || !enough_known) now.measured_at = snapshot.stamp();
  job.shown = now.proximity.status == Measure::not_measured || now.proximity.distance <= job.report;
}

PairDistance PairMeter::State::entryOf(const Snapshot& snapshot, const Job& job) const {
  PairDistance entry;
  entry.first = job.pair->first;
  entry.second = job.pair->second;
  entry.gap = job.pair->gap;
  entry.flags = job.pair->flags;
  if (!job.left_out) {
    entry.proximity = job.known.proximity;
    entry.cells = job.known.cells;
    entry.first_shape = job.known.first_shape;
    entry.second_shape = job.known.second_shape;
    entry.closing_speed = job.known.speed;
  }
  const bool has_distance = entry.proximity.status != Measure::not_measured;
  if (job.known.proximity.status != Measure::not_measured) entry.measured = job.known.measured_at;
  entry.lower_bound = has_distance ? entry.proximity.distance : std::max(entry.gap, boundOf(snapshot, job.known));
  const double least = std::isnan(entry.proximity.distance) ? entry.gap : entry.proximity.distance;
  if (isContact(entry.proximity.status)) {
    entry.time_to_contact = 0.0;
  } else if (!std::isnan(entry.closing_speed)) {
    entry.time_to_contact =
        entry.closing_speed > 0.0 ? least / entry.closing_speed : std::numeric_limits<double>::infinity();
  }
  entry.no_contact_before = snapshot.noContactBefore(entry.first, entry.second, least);
  return entry;
}

std::shared_ptr<const PairDistances> PairMeter::measure(const Snapshot& snapshot) {
  const DefaultFloatEnvironment environment;
  State& s = *state_;
  const Clock::time_point begin = Clock::now();
  const auto budget = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s.options.budget));
  s.recall(snapshot);
  s.scratch.resize(static_cast<std::size_t>(s.workers.threads()));
  std::atomic<bool> out_of_time{false};
  const std::size_t per_job = s.workers.threads() == 1 ? 1 : kPairsPerJob;
  s.workers.run((s.jobs.size() + per_job - 1) / per_job, [&](std::size_t number, std::size_t thread) {
    const DefaultFloatEnvironment of_this_thread;
    const std::size_t end = std::min((number + 1) * per_job, s.jobs.size());
    for (std::size_t i = number * per_job; i < end; ++i) {
      State::Job& job = s.jobs[i];
      if (s.options.budget > 0.0 && !out_of_time && Clock::now() - begin > budget) out_of_time = true;
      if (out_of_time) {
        job.shown = job.left_out = true;
      } else {
        s.perform(snapshot, job, s.scratch[thread]);
      }
    }
  });

  const auto result = std::make_shared<PairDistances>();
  for (State::Job& job : s.jobs) {
    State::Known& now = job.known;
    const double distance = job.left_out ? Proximity::kUnknown : now.proximity.distance;
    if (std::isfinite(distance) && std::isfinite(now.distance) && snapshot.stamp() > now.stamp) {
      const double dt = seconds(snapshot.stamp() - now.stamp), raw = (now.distance - distance) / dt;
      now.speed = std::isnan(now.speed) ? raw : now.speed + (raw - now.speed) * dt / (dt + kSmoothing);
    } else if (snapshot.stamp() != now.stamp) {
      now.speed = Proximity::kUnknown;
    }
    now.distance = distance;
    now.stamp = snapshot.stamp();
    result->left_out += job.left_out;
    result->failed += !job.left_out && now.proximity.status == Measure::failed;
    result->measured += !job.left_out;
    if (job.shown) result->pairs.push_back(s.entryOf(snapshot, job));
  }
  std::sort(result->pairs.begin(), result->pairs.end(), [](const PairDistance& a, const PairDistance& b) {
    const bool unknown_a = std::isnan(a.proximity.distance), unknown_b = std::isnan(b.proximity.distance);
    if (unknown_a != unknown_b) return unknown_b;
    const double key_a = unknown_a ? a.gap : a.proximity.distance, key_b = unknown_b ? b.gap : b.proximity.distance;
    return std::tie(key_a, a.first, a.second) < std::tie(key_b, b.first, b.second);
  });
  s.known.reserve(s.jobs.size());  // this may throw, but the code below cannot
  s.known.clear();
  for (State::Job& job : s.jobs) s.known.push_back(std::move(job.known));
  std::sort(s.known.begin(), s.known.end(), [](const State::Known& a, const State::Known& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  return result;
}

}  // namespace hgrid
