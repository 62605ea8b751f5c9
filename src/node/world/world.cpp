// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/world.h"

#include <algorithm>
#include <set>
#include <utility>

#include "hgrid_proximity/partitions/partitions.h"
#include "hgrid_proximity/refusal.h"
#include "node/world/find_trouble.h"
#include "node/world/unplaced_robots.h"

namespace hgrid {
namespace {

constexpr double kClockJump = 10.0;  // [s] ROS time that gains more than this on real time within a tick has jumped

SceneOptions optionsOf(const Params& params, const std::vector<PairRule>& stored_rules) {
  SceneOptions options;
  options.origin = params.origin;
  options.margin = params.margin;
  options.event_hysteresis = params.event_hysteresis;
  options.broad_phase = [type = params.broad_phase](double finest_edge, int threads) {
    return makeBroadPhase({type, finest_edge, threads});
  };
  if (!params.rooms.empty()) options.building = std::make_shared<const Building>(params.rooms, params.doors);
  options.threads = params.threads;
  options.world_limit = params.world_limit;
  options.growth_cap = params.growth_cap;
  options.growth_after = params.stale_after;
  options.max_bodies = static_cast<std::size_t>(params.max_bodies);
  options.max_planes = static_cast<std::size_t>(params.max_planes);
  options.max_pairs = static_cast<std::size_t>(params.max_pairs);
  options.required = params.required;
  options.pair_kinds = params.pair_kinds;
  options.allowed_pairs = params.allowed_pairs;
  options.allowed_pairs.insert(options.allowed_pairs.end(), stored_rules.begin(), stored_rules.end());
  options.pair_margins = params.pair_margins;
  options.horizon = params.horizon;
  options.report_unmapped = params.map_unknown == UnknownSpace::report;
  return options;
}

void sortUnique(std::vector<std::string>& names) {
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace

World::World(std::shared_ptr<const Settings> settings, bool simulated, std::uint64_t epoch, Ledger& ledger,
             std::shared_ptr<NarrowPhase> narrow_phase, const StoredWorld& stored)
    : first_settings_(std::move(settings)),
      params_(first_settings_->params),
      settings_(first_settings_),
      ledger_(ledger),
      scene_(optionsOf(params_, stored.rules)),
      transforms_(params_.max_future, params_.tf_cache, static_cast<std::size_t>(params_.max_frames), simulated, ledger,
                  static_cast<std::size_t>(params_.max_samples), params_.max_sync_wait),
      clock_(simulated, kClockJump, params_.stale_after),
      movers_(scene_),
      poses_(params_, transforms_, scene_, movers_, ledger),
      missing_(params_),
      robots_(params_, stored.robots, scene_, movers_, missing_),
      obstacles_(params_, narrow_phase, stored, ledger),
      maps_(simulated),
      clouds_(params_, simulated, scene_, ledger),
      tracks_(params_, simulated, *narrow_phase, scene_, ledger),
      world_frame_(params_.world_frame),
      epoch_(epoch) {
  scene_.beginEpoch(epoch_);
  for (const auto& [name, map] : stored.maps) {
    if (map) missing_.set(SourceId::ofMap(name), "NOT_READY map '" + name + "': its file has not been read yet");
  }
  for (const MapParams& map : params_.maps) {
    const auto known = stored.maps.find(map.name);
    if (known != stored.maps.end() && !known->second && map.topic.empty()) missing_.erase(SourceId::ofMap(map.name));
  }
  if (!stored.troubles.empty()) {
    missing_.set(SourceId::ofObstacles("stored"),
                 "NOT_READY " + stored.troubles.front() +
                     "; compare ~bodies with your obstacles, then call ~reset or restart the node");
  }
}

void World::beginEpoch() {
  scene_.beginEpoch(++epoch_);
  poses_.beginEpoch();
}

void World::applyRobots(const RobotChanges& changes, PreparedRobotBodies* prepared) {
  findWorldFrame();
  robots_.apply(changes, world_frame_, prepared);
}

std::shared_ptr<PreparedRobotBodies> World::prepareRobots(const std::function<void(RobotEntries&)>& edit,
                                                          const std::shared_ptr<const Tick>& newest) const {
  if (!newest || !newest->snapshot) return nullptr;
  try {
    RobotEntries after = *newest->robots;
    edit(after);
    return RobotBodies::prepare(*newest->robots, after, *newest->snapshot, scene_);
  } catch (const Refusal&) {
    return nullptr;  // setRobot() or applyRobots() finds out whether the change must be refused
  }
}

void World::setMap(const LoadedMap& map) {
  const std::string what = "map '" + map.params.name + "'";
  if (!findWorldFrame()) {
    throw Refusal(
        Code::not_ready,
        what + " cannot be placed yet: the world frame is not known; load the first robot or set ~world_frame");
  }
  const SourceId source = SourceId::ofMap(map.params.name);
  if (!maps_.has(source) && maps_.size() >= static_cast<std::size_t>(params_.max_maps)) {
    throw Refusal(Code::limit, what + " would be one map too many; ~limits/max_maps is " +
                                   std::to_string(params_.max_maps) +
                                   ": remove a map with ~clear_map, or give it the name of a map to replace");
  }
  const Body body = mapBodyOf(map, world_frame_, params_);
  const bool same = maps_.hasSame(source, body);
  if (maps_.has(source) && !same && !transforms_.lookup().isConnected(world_frame_, body.frame)) {
    throw Refusal(Code::unknown_frame, what + ": its frame '" + printable(body.frame) + "' is not connected to '" +
                                           world_frame_ + "'; the old map stays");
  }
  if (!map.cells || !map.cells->grid)
    throw Refusal(Code::bad_geometry, what + " has no cells; a map must come with its cells");
  MapBodies maps = maps_;
  maps.set(source, body, map);
  if (!same) {  // otherwise only the cells of the map change, and the structure of the scene stays the same
    NewMovers coming;
    coming.add(source, body);
    movers_.exchange([&](const SourceId& other) { return other == source; }, std::move(coming));
  }
  // The code below does not throw, because the body is a map without shapes, and the cells exist.
  BodyId id;
  scene_.find(body.name, id);
  scene_.setCells(id, map.cells);
  maps_.swap(maps);
  missing_.erase(source);
}

void World::clearMap(const std::string& name) {
  const SourceId named = SourceId::ofMap(name);
  if (!name.empty() && !maps_.has(named) && !missing_.has(named)) {
    throw Refusal(Code::unknown_id, "there is no map '" + printable(name) + "'");
  }
  const auto chosen = [&](const SourceId& source) {
    return source.kind == SourceKind::map && (name.empty() || source == named);
  };
  movers_.exchange(chosen, {});
  // The code below does not throw.
  maps_.eraseIf(chosen);
  missing_.eraseIf(chosen);  // the world no longer waits for these maps
}

void World::setCloud(const LoadedCloud& cloud) {
  const SourceId source = SourceId::ofCloud(cloud.name);
  clouds_.set(source, cloud, world_frame_);
  missing_.erase(source);
}

void World::setTracks(const std::string& tracker, std::shared_ptr<const TrackSet> set) {
  const SourceId source = SourceId::ofTracker(tracker);
  if (!set->heard) {
    missing_.set(source, "REFUSED '" + source.name + "': no message could be used yet (" + set->refused + ")");
    return;
  }
  tracks_.set(tracker, std::move(set), world_frame_);
  missing_.erase(source);
}

void World::setDataFrames(const SourceId& source, const std::vector<std::string>& frames) {
  data_frames_[source] = frames;
  needed_revision_.reset();
}

/// Tells the transforms which frames have priority, and which are free, if the bodies or the robots have changed.
void World::needFrames(const Moment& now) {
  const std::pair<std::uint64_t, std::uint64_t> revision(movers_.revision(), robots_.models().revision());
  if (needed_revision_ == revision) return;
  std::vector<std::string> frames{world_frame_};
  for (const Mover& mover : movers_.all()) {
    if (mover.frame != frames.back()) frames.push_back(mover.frame);  // successive obstacles often have the same frame
  }
  for (const auto& data : data_frames_) frames.insert(frames.end(), data.second.begin(), data.second.end());
  transforms_.need(frames, now);
  transforms_.setFree(freeFrames(robots_.models().all()));
  needed_revision_ = revision;
}

void World::setMissing(const SourceId& source, const std::string& sentence) {
  if (clouds_.noteRefused(source, sentence) || maps_.noteRefused(source, sentence)) return;
  if (source.kind == SourceKind::robot) return robots_.noteRefused(source.name, sentence);
  missing_.set(source, sentence);
}

std::shared_ptr<PreparedObstacles> World::prepareObstacles(const ObstacleChanges& changes,
                                                           const std::shared_ptr<const Tick>& newest, Time now,
                                                           const std::vector<PairRule>* rules) const {
  return newest ? obstacles_.prepare(changes, *newest, now, transforms_.lookup(), scene_, rules) : nullptr;
}

void World::applyObstacles(const ObstacleChanges& changes, Time now, PreparedObstacles* prepared) {
  if (!findWorldFrame() || !clock_.running()) {
    throw Refusal(Code::not_ready,
                  "obstacles cannot be placed yet: " +
                      std::string(clock_.running() ? "the world frame is not known; load the first robot or set "
                                                     "~world_frame"
                                                   : "there is no time yet, because nothing is published on /clock"));
  }
  obstacles_.addAll(world_frame_, now, movers_, missing_);  // so that a change can be about a configured obstacle
  std::set<SourceId> named;
  if (missing_.hasKind(SourceKind::obstacle)) {
    for (const ObstacleChange& change : changes.changes) named.insert(SourceId::ofObstacle(change.name));
  }
  obstacles_.apply(changes, {params_, world_frame_, transforms_.lookup(), robots_.models().all(), now}, movers_,
                   prepared);
  // The code below does not throw. A configured obstacle that was refused is no longer missing if it was changed.
  missing_.eraseIf([&](const SourceId& source) { return named.count(source) != 0; });
}

void World::setRules(PreparedRules rules) { rules_.set(std::move(rules)); }

void World::setSettings(std::shared_ptr<const Settings> settings) {
  const Params& params = settings->params;
  scene_.tune({params.margin, params.event_hysteresis, params.growth_cap, params.horizon});
  settings_ = std::move(settings);
}

void World::reset() {
  const auto is_obstacle = [](const SourceId& source) { return source.kind == SourceKind::obstacle; };
  SharedObstacles::Spare spare;
  robots_.reset(is_obstacle);
  // The code below does not throw.
  obstacles_.startAgain(std::move(spare));
  robots_.setPaddings({});
  setMatrix({});
  missing_.eraseIf(is_obstacle);
  ledger_.clear();
  beginEpoch();
}

/// Sets the world frame, unless it is known already. Without ~world_frame, it is the root link of the first robot.
/// @returns whether the world frame is known
bool World::findWorldFrame() {
  if (world_frame_.empty()) {
    world_frame_ = robots_.models().firstRoot();
    needed_revision_.reset();
  }
  return !world_frame_.empty();
}

void World::handleClock(const Moment& now) {
  const ClockWatch::Event jump = clock_.look(now);
  transforms_.ages().look(now, clock_.frozen());
  if (jump == ClockWatch::Event::none) return;
  const bool back = jump == ClockWatch::Event::jumped_back;
  const Refusal refusal(Code::clock,
                        std::string("ROS time jumped ") + (back ? "back" : "ahead") + "; a new epoch begins");
  if (!clock_.simulated()) {
    transforms_.restamp();
    poses_.restamp(now, false);
  } else if (back) {  // the transforms belong to an earlier run of the simulation
    transforms_.forgetMoving();
    poses_.restamp(now, true);
  }
  obstacles_.restamp(now.ros);
  beginEpoch();
  clock_.noteHandled();
  ledger_.refuse("clock", refusal);
}

/// Returns a SourceGap for each missing source and each map whose cells cannot be trusted. Also lists them in `tick`.
std::vector<SourceGap> World::listMissing(const Moment& now, Tick& tick) const {
  std::vector<SourceGap> gaps = maps_.gaps(now);
  missing_.appendGaps(gaps);
  for (const SourceGap& gap : gaps) tick.not_ready.push_back(gap.sentence);
  if (!gaps.empty()) tick.waits_for = gaps.front().source;
  const auto add = [&](const char* subject, const char* sentence) {
    if (tick.not_ready.empty()) tick.waits_for = subject;
    tick.not_ready.push_back(sentence);
  };
  if (!clock_.running())
    add("clock", "NOT_READY: there is no time yet; /use_sim_time is set, but nothing is published on /clock");
  if (world_frame_.empty()) {
    add("world frame",
        "NOT_READY: the world frame is the root of a robot that is not loaded yet; set ~world_frame if this robot "
        "does not come");
  }
  return gaps;
}

std::shared_ptr<Tick> World::tick(const Moment& now) {
  auto tick = std::make_shared<Tick>();
  handleClock(now);
  tick->settings = settings_;
  tick->made = now;
  tick->epoch = epoch_;
  const bool can_begin = findWorldFrame() && clock_.running();
  // This comes before listMissing(), because obstacles that are refused become missing sources.
  if (can_begin) obstacles_.addAll(world_frame_, now.ros, movers_, missing_);
  if (can_begin) obstacles_.followRobots(robots_.models(), world_frame_, movers_);
  if (can_begin) obstacles_.expire(now.ros, movers_);
  robots_.padLinks();
  rules_.apply(now, obstacles_.touchRules(), matrix_.rules(robots_.models()), scene_);
  needFrames(now);
  tick->world_frame = world_frame_;
  tick->models = robots_.models().report();
  tick->robots = robots_.models().shared();
  tick->frames = transforms_.table().placed();
  std::vector<SourceGap> gaps = listMissing(now, *tick);
  if (!can_begin) {
    transforms_.news().await({}, Time(0), now.ros);  // transforms alone are no reason for the next tick
    return tick;
  }

  const auto begin = std::chrono::steady_clock::now();
  const Time time = poses_.update(now, clock_.frozen(), *tick);
  transforms_.news().await(poses_.awaited(), time, now.ros);
  tick->contested_frames = transforms_.claims().sentences(poses_.reading());
  tick->clock_offsets = transforms_.publisherClocks().offsets(poses_.reading());
  clouds_.update(now, clock_.frozen(), *tick, gaps);
  tracks_.update(now, clock_.frozen(), *tick, gaps);
  sortWorstFirst(tick->troubles);
  if (!tick->troubles.empty() && tick->troubles.front().state == Freshness::unplaced) {
    tick->unplaced = whyUnplaced(movers_.all(), robots_.models().all(), transforms_.table(), world_frame_,
                                 world_frame_ == params_.world_frame);
  }
  sortUnique(tick->missing_frames);
  tick->poses_time = std::chrono::steady_clock::now() - begin;
  tick->snapshot = scene_.commit(time, gaps);
  tick->times = scene_.lastTimes();
  tick->threads = scene_.lastThreads();
  return tick;
}

}  // namespace hgrid
