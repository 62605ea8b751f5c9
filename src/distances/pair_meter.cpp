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
#include "distances/nearest_shapes.h"
#include "hgrid_proximity/geometry/float_environment.h"

namespace hgrid {
namespace {

/// Returns whether a body is where its pose says: FRESH, and not so old that it may be elsewhere.
bool isFresh(const Snapshot& snapshot, std::uint32_t body) {
  const BodyPose& pose = snapshot.poses()[body];
  return pose.state == Freshness::fresh && pose.reach == 0.0;
}

using Clock = std::chrono::steady_clock;

constexpr double kRounding = 1e-12;      // relative to sizes and coordinates: rounding errors of two measurements
constexpr double kLittle = 0.25;         // a move is small if it is less than this fraction of the report distance
constexpr double kSmoothing = 0.05;      // [s] time constant of the low-pass filter for the closing speed
constexpr std::size_t kPairsPerJob = 8;  // number of pairs that a thread measures before it takes the next job

}  // namespace

struct PairMeter::State {
  /// The result of the last measurement of a pair.
  struct Known {
    std::uint32_t first = 0, second = 0;
    bool measured = false;  // whether the pair was ever measured; if not, the members below are meaningless
    Time measured_at{0};    // stamp of the newest snapshot for which this result is valid
    Pose world_from_first = Pose::Identity(), world_from_second = Pose::Identity();
    std::uint32_t first_shape = 0, second_shape = 0;
    Proximity proximity;
    Contact contact;
    std::vector<NearCell> cells;
    std::shared_ptr<const MapCells> map;  // the cells of the map at the measurement; null if neither body is a map
    double up_to = 0.0;                   // [m] larger distances were not searched
    // The last sample of the distance, for the closing speed.
    Time stamp{0};
    double distance = Proximity::kUnknown, speed = Proximity::kUnknown;
    // Sequence number of the last snapshot that did not leave out the pair. If there is none: sequence number of the
    // last snapshot before the pair appeared.
    std::uint64_t served = 0;
  };
  struct Job {
    const NearPair* pair;
    double report;         // [m] a pair that is farther apart is not listed
    Known known;           // input: the last result; output: the new result
    double moved = 0.0;    // [m] see motionSince()
    double bound = 0.0;    // [m] lower bound of the distance, from the boxes and the last result
    bool left_out = true;  // whether the pair needs a measurement that was not made (yet)
  };

  State(std::shared_ptr<const NarrowPhase> phase, const MeterOptions& given)
      : narrow_phase(std::move(phase)), options(given), workers(given.threads) {}

  void recall(const Snapshot& snapshot);
  static std::shared_ptr<const MapCells> mapOf(const Snapshot& snapshot, const Known& known);
  static double motionSince(const Snapshot& snapshot, const Known& known);
  static double errorOf(const Snapshot& snapshot, const Known& known);
  static void assess(const Snapshot& snapshot, Job& job);
  void measureDue(const Snapshot& snapshot, Clock::time_point begin);
  void measureUntil(const Snapshot& snapshot, Clock::time_point deadline, std::size_t at_least);
  void perform(const Snapshot& snapshot, Job& job, std::vector<ShapePair>& shape_pairs) const;
  static void updateSpeed(const Snapshot& snapshot, Job& job);
  PairDistance entryOf(const Snapshot& snapshot, const Job& job) const;
  std::shared_ptr<const PairDistances> result(const Snapshot& snapshot) const;

  std::shared_ptr<const NarrowPhase> narrow_phase;
  MeterOptions options;
  Workers workers;
  std::uint64_t revision = 0, epoch = 0;
  std::vector<Known> known;  // the last results of the pairs, sorted by (first, second)
  std::vector<Job> jobs;
  std::vector<Job*> due;
  std::vector<std::vector<ShapePair>> scratch;  // one buffer for each thread
};

PairMeter::PairMeter(std::shared_ptr<const NarrowPhase> narrow_phase, const MeterOptions& options)
    : state_(std::make_unique<State>(std::move(narrow_phase), options)) {}
PairMeter::~PairMeter() = default;

/// Creates the jobs, each with the last result of its pair.
void PairMeter::State::recall(const Snapshot& snapshot) {
  const Structure& structure = snapshot.structure();
  if (revision != structure.revision || epoch != snapshot.epoch()) known.clear();  // the body indices may have changed
  revision = structure.revision;
  epoch = snapshot.epoch();
  jobs.clear();
  auto last = known.begin();
  for (const NearPair& pair : snapshot.pairs()) {
    // If margins grow because data is old, the report distance grows by the same length.
    const double report = structure.pair_margins.of(pair.first, pair.second).value_or(options.report_distance) +
                          snapshot.growthOf(pair.first, pair.second);
    const auto before = [&](const Known& one) {
      return one.first != pair.first ? one.first < pair.first : one.second < pair.second;
    };
    while (last != known.end() && before(*last)) ++last;
    if (pair.gap > report) continue;
    jobs.push_back({&pair, report, {}});
    Known& now = jobs.back().known;
    now.served = snapshot.sequence() - 1;
    if (last != known.end() && last->first == pair.first && last->second == pair.second) now = *last;
    now.first = pair.first;
    now.second = pair.second;
  }
}

/// Returns the cells of the map in a pair; null if neither body is a map.
std::shared_ptr<const MapCells> PairMeter::State::mapOf(const Snapshot& snapshot, const Known& known) {
  return snapshot.cellsOf(snapshot.structure().isMap(known.first) ? known.first : known.second);
}

/// Returns the largest possible change [m] of the distance of a pair since its last measurement, computed from the
/// poses of its bodies. Infinite if the pair was never measured or if the cells of its map have changed.
double PairMeter::State::motionSince(const Snapshot& snapshot, const Known& known) {
  const Structure& structure = snapshot.structure();
  const bool map_first = structure.isMap(known.first);
  const auto map = mapOf(snapshot, known);
  if (!known.measured || known.map != map) return std::numeric_limits<double>::infinity();
  const Pose &first = snapshot.poses()[known.first].world_from_body,
             &second = snapshot.poses()[known.second].world_from_body;
  if (first.matrix() == known.world_from_first.matrix() && second.matrix() == known.world_from_second.matrix())
    return 0.0;
  // relativeMotion() needs the reach of the second body. A body with a plane has none.
  if (map_first || (!map && !structure.hasPlane(known.second))) {
    return relativeMotion(known.world_from_first, known.world_from_second, first, second,
                          reachOf(structure.bodies[known.second]));
  }
  return relativeMotion(known.world_from_second, known.world_from_first, second, first,
                        reachOf(structure.bodies[known.first]));
}

/// Computes from the last result of a pair: its motion, its lower bound, and whether it must be measured.
void PairMeter::State::assess(const Snapshot& snapshot, Job& job) {
  Known& now = job.known;
  job.moved = motionSince(snapshot, now);
  const double at_least =
      std::min(now.proximity.lower_bound, now.up_to) - job.moved;  // NaN without a measured distance
  job.bound = std::max(job.pair->gap, now.proximity.status == Measure::not_measured ? 0.0 : at_least);
  const bool enough_known = job.moved == 0.0 ? now.up_to >= job.report : at_least > job.report;
  job.left_out = !now.measured || !enough_known;
  if (job.moved == 0.0 && !job.left_out) now.measured_at = snapshot.stamp();
}

/// Measures the pairs that must be measured, in the order that the comment of PairMeter describes.
void PairMeter::State::measureDue(const Snapshot& snapshot, Clock::time_point begin) {
  due.clear();
  for (Job& job : jobs) {
    if (job.left_out) due.push_back(&job);
  }
  const auto by_bound = [](const Job* job) {
    return std::tie(job->bound, job->pair->gap, job->pair->first, job->pair->second);
  };
  std::sort(due.begin(), due.end(), [&](const Job* a, const Job* b) { return by_bound(a) < by_bound(b); });
  if (options.budget == 0.0) return measureUntil(snapshot, begin, due.size());
  const auto budget = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.budget));
  measureUntil(snapshot, begin + budget / 2, 0);
  std::stable_sort(due.begin(), due.end(),
                   [](const Job* a, const Job* b) { return a->known.served < b->known.served; });
  measureUntil(snapshot, begin + budget, 1);
}

/// Measures the pairs in `due` in their order, and removes them from `due`. Ends at the deadline, but not before the
/// first `at_least` pairs were measured.
void PairMeter::State::measureUntil(const Snapshot& snapshot, Clock::time_point deadline, std::size_t at_least) {
  std::atomic<bool> out_of_time{false};
  const std::size_t per_job = workers.threads() == 1 ? 1 : kPairsPerJob;
  workers.run((due.size() + per_job - 1) / per_job, [&](std::size_t number, std::size_t thread) {
    const DefaultFloatEnvironment of_this_thread;
    const std::size_t end = std::min((number + 1) * per_job, due.size());
    for (std::size_t i = number * per_job; i < end; ++i) {
      if (i >= at_least && (out_of_time || options.now() > deadline)) {
        out_of_time = true;
        return;
      }
      perform(snapshot, *due[i], scratch[thread]);
    }
  });
  due.erase(std::remove_if(due.begin(), due.end(), [](const Job* job) { return !job->left_out; }), due.end());
}

/// Returns a bound [m] of the error of a measured distance, and of the next one. It is infinite for a plane.
double PairMeter::State::errorOf(const Snapshot& snapshot, const Known& known) {
  double size = known.proximity.distance;
  for (const std::uint32_t body : {known.first, known.second}) {
    if (!snapshot.structure().isMap(body)) size += reachOf(snapshot.structure().bodies[body]);
    size += (snapshot.poses()[body].world_from_body.translation() - snapshot.origin()).norm();
  }
  return kRounding * size;
}

void PairMeter::State::perform(const Snapshot& snapshot, Job& job, std::vector<ShapePair>& shape_pairs) const {
  Known& now = job.known;
  // The distance cannot exceed this bound by more than the errors of two measurements, so no larger distance is
  // searched.
  const double at_most = now.proximity.distance + job.moved + errorOf(snapshot, now);
  // After a small move, search a little farther than the report distance, so that the next tick need not measure.
  now.up_to = job.moved < kLittle * job.report ? (1.0 + kLittle) * job.report : job.report;
  now.world_from_first = snapshot.poses()[now.first].world_from_body;
  now.world_from_second = snapshot.poses()[now.second].world_from_body;
  const NearestShapes nearest = nearestShapes(*narrow_phase, snapshot, now.first, now.second,
                                              at_most < now.up_to ? at_most : now.up_to, shape_pairs);
  now.first_shape = nearest.first;
  now.second_shape = nearest.second;
  now.proximity = nearest.proximity;
  now.contact = nearest.contact;
  now.cells = nearest.cells;
  now.map = mapOf(snapshot, now);
  now.measured = true;
  now.measured_at = snapshot.stamp();
  job.left_out = false;
}

/// Updates the estimate of the closing speed, and stores the distance as its newest sample.
void PairMeter::State::updateSpeed(const Snapshot& snapshot, Job& job) {
  Known& now = job.known;
  const double distance = job.left_out ? Proximity::kUnknown : now.proximity.distance;
  if (std::isfinite(distance) && std::isfinite(now.distance) && snapshot.stamp() > now.stamp) {
    const double dt = seconds(snapshot.stamp() - now.stamp), raw = (now.distance - distance) / dt;
    now.speed = std::isnan(now.speed) ? raw : now.speed + (raw - now.speed) * dt / (dt + kSmoothing);
  } else if (snapshot.stamp() != now.stamp) {
    now.speed = Proximity::kUnknown;
  }
  now.distance = distance;
  now.stamp = snapshot.stamp();
}

PairDistance PairMeter::State::entryOf(const Snapshot& snapshot, const Job& job) const {
  PairDistance entry;
  entry.first = job.pair->first;
  entry.second = job.pair->second;
  entry.gap = job.pair->gap;
  entry.flags = job.pair->flags;
  if (!job.left_out) {
    entry.proximity = job.known.proximity;
    entry.contact = job.known.contact;
    entry.cells = job.known.cells;
    entry.first_shape = job.known.first_shape;
    entry.second_shape = job.known.second_shape;
    entry.closing_speed = job.known.speed;
  }
  const bool has_distance = entry.proximity.status != Measure::not_measured;
  if (job.known.proximity.status != Measure::not_measured) entry.measured = job.known.measured_at;
  const double at_poses = has_distance ? entry.proximity.lower_bound : job.bound;
  entry.lower_bound = std::max(0.0, at_poses - snapshot.reachBetween(entry.first, entry.second));
  const double least = std::isnan(entry.proximity.distance) ? entry.gap : entry.proximity.lower_bound;
  if (!isFresh(snapshot, entry.first) || !isFresh(snapshot, entry.second)) entry.closing_speed = Proximity::kUnknown;
  if (isContact(entry.proximity.status)) {
    entry.approach = Approach::contact;
    entry.time_to_contact = 0.0;
  } else if (entry.closing_speed > 0.0) {
    entry.approach = Approach::approaching;
    entry.time_to_contact = least / entry.closing_speed;
  } else if (!std::isnan(entry.closing_speed)) {
    entry.approach = Approach::apart;
    entry.time_to_contact = std::numeric_limits<double>::infinity();
  }
  const NoContact no_contact = snapshot.noContactBefore(entry.first, entry.second, least);
  entry.no_contact_before = no_contact.before;
  if (no_contact.assumed) entry.flags |= kAssumedFlag;
  return entry;
}

std::shared_ptr<const PairDistances> PairMeter::State::result(const Snapshot& snapshot) const {
  const auto result = std::make_shared<PairDistances>();
  for (const Job& job : jobs) {
    const Proximity& proximity = job.known.proximity;
    result->left_out += job.left_out;
    result->failed += !job.left_out && proximity.status == Measure::failed;
    result->measured += !job.left_out;
    if (job.left_out) result->longest_wait = std::max(result->longest_wait, snapshot.sequence() - job.known.served);
    const bool near = proximity.status == Measure::not_measured || proximity.distance <= job.report;
    if (job.left_out || near) result->pairs.push_back(entryOf(snapshot, job));
  }
  std::sort(result->pairs.begin(), result->pairs.end(), [](const PairDistance& a, const PairDistance& b) {
    const bool unknown_a = std::isnan(a.proximity.distance), unknown_b = std::isnan(b.proximity.distance);
    if (unknown_a != unknown_b) return unknown_b;
    const double key_a = unknown_a ? a.gap : a.proximity.distance, key_b = unknown_b ? b.gap : b.proximity.distance;
    return std::tie(key_a, a.first, a.second) < std::tie(key_b, b.first, b.second);
  });
  return result;
}

void PairMeter::tune(double report_distance, double budget) {
  state_->options.report_distance = report_distance;
  state_->options.budget = budget;
}

int PairMeter::threads() const { return state_->workers.threads(); }

std::shared_ptr<const PairDistances> PairMeter::measure(const Snapshot& snapshot) {
  const DefaultFloatEnvironment environment;
  State& s = *state_;
  const Clock::time_point begin = s.options.now();
  s.recall(snapshot);
  s.scratch.resize(static_cast<std::size_t>(s.workers.threads()));
  for (State::Job& job : s.jobs) State::assess(snapshot, job);
  s.measureDue(snapshot, begin);
  for (State::Job& job : s.jobs) State::updateSpeed(snapshot, job);
  auto result = s.result(snapshot);
  s.known.reserve(s.jobs.size());  // this may throw, but the code below cannot
  s.known.clear();
  for (State::Job& job : s.jobs) {
    if (!job.left_out) job.known.served = snapshot.sequence();
    s.known.push_back(std::move(job.known));
  }
  return result;
}

}  // namespace hgrid
