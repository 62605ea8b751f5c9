// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/world.h"

#include <algorithm>
#include <set>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/world/robot_edits.h"
#include "node/world/unplaced_robots.h"

namespace hgrid {
namespace {

SceneOptions optionsOf(const Params& params, const std::vector<PairRule>& stored_rules) {
  SceneOptions options;
  options.origin = params.origin;
  options.margin = params.margin;
  options.event_hysteresis = params.event_hysteresis;
  options.broad_phase = params.broad_phase;
  options.finest_edge = params.finest_edge;
  options.threads = params.threads;
  options.world_limit = params.world_limit;
  options.growth_cap = params.growth_cap;
  options.growth_after = params.stale_after;
  options.max_bodies = static_cast<std::size_t>(params.max_bodies);
  options.max_planes = static_cast<std::size_t>(params.max_planes);
  options.max_pairs = static_cast<std::size_t>(params.max_pairs);
  options.max_reasons = static_cast<std::size_t>(params.max_reasons);
  options.required = params.required;
  options.pair_kinds = params.pair_kinds;
  options.allowed_pairs = params.allowed_pairs;
  options.allowed_pairs.insert(options.allowed_pairs.end(), stored_rules.begin(), stored_rules.end());
  options.pair_margins = params.pair_margins;
  options.horizon = params.horizon;
  options.report_unmapped = params.map_unknown == UnknownSpace::report;
  return options;
}

/// Returns the robots of `next` that must enter the scene, because it does not have them or has another model of them.
std::vector<std::shared_ptr<const LoadedRobot>> entering(const RobotEntries& present, const RobotEntries& next) {
  std::vector<std::shared_ptr<const LoadedRobot>> robots;
  for (const auto& [name, robot] : next) {
    const auto old = present.find(name);
    const bool stays = old != present.end() && old->second.inWorld() && old->second.model == robot.model;
    if (robot.inWorld() && !stays) robots.push_back(robot.model);
  }
  return robots;
}

/// Returns how many bodies of `present` leave the scene if the robots become `next`.
std::size_t leavingBodies(const RobotEntries& present, const RobotEntries& next) {
  std::size_t bodies = 0;
  for (const std::shared_ptr<const LoadedRobot>& robot : entering(next, present)) bodies += robot->bodies.size();
  return bodies;
}

/// Returns the first robot whose bodies do not fit into ~max_bodies; null: all fit.
/// @param others  number of bodies in the world that belong to no robot of `robots`
const LoadedRobot* findTooLarge(const std::vector<std::shared_ptr<const LoadedRobot>>& robots, std::size_t others,
                                const Params& params) {
  for (const std::shared_ptr<const LoadedRobot>& robot : robots) {
    others += robot->bodies.size();
    if (others > static_cast<std::size_t>(params.max_bodies)) return robot.get();
  }
  return nullptr;
}

Refusal tooLarge(const LoadedRobot& robot, const Params& params) {
  return {Code::limit, "robot '" + robot.name + "' has " + std::to_string(robot.bodies.size()) +
                           " bodies; with them, the world would have more than ~max_bodies, " +
                           std::to_string(params.max_bodies)};
}

/// Returns what a robot lacks; empty: nothing, or it is not expected to be in the world.
std::string lackOf(const std::string& name, const RobotEntry& robot) {
  if (robot.absent) return {};
  if (!robot.model) return "NOT_READY robot '" + name + "': its description has not been read yet";
  if (!robot.refused.empty()) {
    return "REFUSED '" + name + "': its newest description could not be used (" + robot.refused +
           "), so its model may be out of date";
  }
  return robot.model->gap.empty() ? "" : "UNCOVERED " + robot.model->gap;
}

bool isSameEntry(const RobotEntry& a, const RobotEntry& b) {
  return a.spec == b.spec && a.model == b.model && a.absent == b.absent && a.refused == b.refused;
}

/// Updates what the robots lack. What is known of a robot that does not change stays.
void updateMissing(const RobotEntries& present, const RobotEntries& next, MissingSources& missing) {
  for (const auto& robot : present) {
    if (next.count(robot.first) == 0) missing.erase(SourceId::ofRobot(robot.first));
  }
  for (const auto& [name, robot] : next) {
    const auto old = present.find(name);
    if (old != present.end() && isSameEntry(old->second, robot)) continue;
    const std::string lack = lackOf(name, robot);
    lack.empty() ? missing.erase(SourceId::ofRobot(name)) : missing.set(SourceId::ofRobot(name), lack);
  }
}

/// Adds a mover for each group of links that move together.
void addMovers(const LoadedRobot& robot, const LinkPaddings& paddings, Movers::Change& change) {
  const SourceId source = SourceId::ofRobot(robot.name);
  for (const LoadedRobot::Group& group : robot.groups) {
    bool first = true;
    for (const auto& [body, frame_from_body] : group.members) {
      if (std::exchange(first, false)) {
        change.add(group.frame, source, padded(robot.bodies[body], paddings), frame_from_body);
      } else {
        change.join(padded(robot.bodies[body], paddings), frame_from_body);
      }
    }
  }
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
      clock_(simulated, params_.clock_jump, params_.stale_after),
      movers_(scene_),
      poses_(params_, transforms_, scene_, movers_, ledger),
      robots_(params_, stored.robots),
      obstacles_(params_, narrow_phase, stored, ledger),
      maps_(simulated),
      clouds_(params_, simulated, scene_, ledger),
      tracks_(params_, simulated, *narrow_phase, scene_, ledger),
      missing_(params_),
      world_frame_(params_.world_frame),
      epoch_(epoch) {
  scene_.beginEpoch(epoch_);
  updateMissing({}, robots_.all(), missing_);
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

void World::setRobot(LoadedRobot loaded) {
  const auto robot = std::make_shared<const LoadedRobot>(std::move(loaded));
  RobotEntries next = robots_.all();
  RobotEntry& entry = next[robot->name];
  if (!entry.spec) {
    RobotSpec spec;
    spec.params.name = robot->name;
    entry.spec = std::make_shared<const RobotSpec>(std::move(spec));
  }
  entry.model = robot;
  entry.refused.clear();
  exchangeRobots(std::move(next), nullptr);
}

void World::applyRobots(const RobotChanges& changes) {
  RobotEntries next = robots_.all();
  std::map<std::string, std::size_t> bringing;  // index of the last change that brings a robot into the world, by name
  findWorldFrame();
  for (const RobotChange& change : changes) {
    try {
      edit(change, params_, next);
      if (change.operation == RobotOperation::add && params_.world_frame.empty())
        checkSharesRoot(*change.model, world_frame_);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(change.index, refusal);
    }
    if (next.count(change.name) != 0) bringing[change.name] = change.index;
  }
  const std::size_t others = scene_.size() - leavingBodies(robots_.all(), next);
  if (const LoadedRobot* robot = findTooLarge(entering(robots_.all(), next), others, params_))
    throw ChangeRefusal(bringing[robot->name], tooLarge(*robot, params_));
  exchangeRobots(std::move(next), nullptr);
}

/// Replaces the robots, all of them or none. @param leaves_too  which other sources leave the world; may be empty
void World::exchangeRobots(RobotEntries next, const std::function<bool(const SourceId&)>& leaves_too) {
  const RobotEntries& present = robots_.all();
  std::set<std::string> leaving;
  for (const std::shared_ptr<const LoadedRobot>& robot : entering(next, present)) leaving.insert(robot->name);
  const std::vector<std::shared_ptr<const LoadedRobot>> coming = entering(present, next);
  if (!leaves_too) {
    const std::size_t others = scene_.size() - leavingBodies(present, next);
    if (const LoadedRobot* robot = findTooLarge(coming, others, params_)) throw tooLarge(*robot, params_);
  }
  MissingSources missing = missing_;
  updateMissing(present, next, missing);
  const bool changes_bodies = leaves_too || !leaving.empty() || !coming.empty();
  std::optional<Movers::Change> change;
  if (changes_bodies) {
    change = movers_.changeWithout([&](const SourceId& source) {
      return (source.kind == SourceKind::robot && leaving.count(source.name) != 0) ||
             (leaves_too && leaves_too(source));
    });
    for (const std::shared_ptr<const LoadedRobot>& robot : coming) addMovers(*robot, paddings_, *change);
  }
  RobotModels robots = robots_;
  robots.set(std::move(next));
  if (change) movers_.exchange(std::move(*change));
  // The code below does not throw.
  robots_.swap(robots);
  missing_.swap(missing);
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
    throw Refusal(Code::limit, what + " would be one map too many; ~max_maps is " + std::to_string(params_.max_maps) +
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
    Movers::Change change = movers_.changeWithout([&](const SourceId& other) { return other == source; });
    change.add(body.frame, source, body, body.frame_from_body);
    movers_.exchange(std::move(change));
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
  movers_.exchange(movers_.changeWithout(chosen));
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

/// Tells the transforms which frames have priority, if the bodies have changed.
void World::needFrames(const Moment& now) {
  if (needed_revision_ == movers_.revision()) return;
  std::vector<std::string> frames{world_frame_};
  for (const Mover& mover : movers_.all()) frames.push_back(mover.frame);
  for (const auto& data : data_frames_) frames.insert(frames.end(), data.second.begin(), data.second.end());
  transforms_.need(frames, now);
  needed_revision_ = movers_.revision();
}

void World::setMissing(const SourceId& source, const std::string& sentence) {
  if (clouds_.noteRefused(source, sentence) || maps_.noteRefused(source, sentence)) return;
  const RobotEntry* known = source.kind == SourceKind::robot ? robots_.entry(source.name) : nullptr;
  if (source.kind == SourceKind::robot && known == nullptr) return;  // it was removed
  if (known == nullptr || (!known->model && !known->absent)) {
    missing_.set(source, sentence);
  } else if (known->model && known->refused != sentence) {
    RobotEntries next = robots_.all();
    next.at(source.name).refused = sentence;
    exchangeRobots(std::move(next), nullptr);
  }
}

void World::applyObstacles(const ObstacleChanges& changes, Time now) {
  if (!findWorldFrame() || !clock_.running()) {
    throw Refusal(Code::not_ready,
                  "obstacles cannot be placed yet: " +
                      std::string(clock_.running() ? "the world frame is not known; load the first robot or set "
                                                     "~world_frame"
                                                   : "there is no time yet, because nothing is published on /clock"));
  }
  std::set<SourceId> named;
  for (const ObstacleChange& change : changes.changes) named.insert(SourceId::ofObstacle(change.name));
  obstacles_.addAll(world_frame_, now, movers_, missing_);  // so that a change can be about a configured obstacle
  obstacles_.apply(changes, {params_, world_frame_, transforms_.lookup(), robots_, now}, movers_);
  // The code below does not throw. A configured obstacle that was refused is no longer missing if it was changed.
  missing_.eraseIf([&](const SourceId& source) { return named.count(source) != 0; });
}

void World::setRules(PreparedRules rules) { rules_.set(std::move(rules)); }

void World::setLinkPaddings(LinkPaddings paddings) noexcept {
  paddings_changed_ = paddings_changed_ || paddings != paddings_;
  paddings_.swap(paddings);
}

/// Replaces the robots of which a link has another padding now.
void World::padLinks() {
  const auto differs = [&](const Body& link) {
    BodyId id;
    if (!scene_.find(link.name, id)) return false;
    const std::vector<BodyShape>& now = scene_.body(id).shapes;
    const std::vector<BodyShape> next = padded(link, paddings_).shapes;
    return !std::equal(now.begin(), now.end(), next.begin(), next.end(),
                       [](const BodyShape& a, const BodyShape& b) { return a.padding == b.padding; });
  };
  std::vector<const LoadedRobot*> others;
  for (const auto& entry : robots_.all()) {
    const LoadedRobot* robot = robots_.find(entry.first);
    if (robot != nullptr && std::any_of(robot->bodies.begin(), robot->bodies.end(), differs)) others.push_back(robot);
  }
  if (!others.empty()) {
    Movers::Change change = movers_.changeWithout([&](const SourceId& source) {
      return std::any_of(others.begin(), others.end(),
                         [&](const LoadedRobot* robot) { return source == SourceId::ofRobot(robot->name); });
    });
    for (const LoadedRobot* robot : others) addMovers(*robot, paddings_, change);
    movers_.exchange(std::move(change));
  }
  paddings_changed_ = false;
}

void World::setSettings(std::shared_ptr<const Settings> settings) {
  const Params& params = settings->params;
  scene_.tune({params.margin, params.event_hysteresis, params.growth_cap, params.horizon});
  settings_ = std::move(settings);
}

void World::reset() {
  const auto is_obstacle = [](const SourceId& source) { return source.kind == SourceKind::obstacle; };
  exchangeRobots(robots_.configured(), is_obstacle);
  // The code below does not throw.
  obstacles_.startAgain();
  setLinkPaddings({});
  setMatrix({});
  missing_.eraseIf(is_obstacle);
  ledger_.clear();
  beginEpoch();
}

/// Sets the world frame, unless it is known already. Without ~world_frame, it is the root link of the first robot.
/// @returns whether the world frame is known
bool World::findWorldFrame() {
  if (world_frame_.empty()) {
    world_frame_ = robots_.firstRoot();
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
  if (can_begin) obstacles_.followRobots(robots_, world_frame_, movers_);
  if (can_begin) obstacles_.expire(now.ros, movers_);
  if (paddings_changed_) padLinks();
  rules_.apply(now, obstacles_.touchRules(), matrix_.rules(robots_), scene_);
  needFrames(now);
  tick->world_frame = world_frame_;
  tick->models = robots_.report();
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
  clouds_.update(time, now, clock_.frozen(), *tick, gaps);
  tracks_.update(time, now, clock_.frozen(), *tick, gaps);
  sortWorstFirst(tick->troubles);
  if (!tick->troubles.empty() && tick->troubles.front().state == Freshness::unplaced) {
    tick->unplaced = whyUnplaced(movers_.all(), transforms_.table(), world_frame_, world_frame_ == params_.world_frame);
  }
  sortUnique(tick->missing_frames);
  tick->poses_time = std::chrono::steady_clock::now() - begin;
  tick->snapshot = scene_.commit(time, gaps);
  tick->times = scene_.lastTimes();
  tick->threads = scene_.lastThreads();
  return tick;
}

}  // namespace hgrid
