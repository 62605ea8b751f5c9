// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

SceneOptions optionsOf(const Params& params) {
  SceneOptions options;
  options.origin = params.origin;
  options.margin = params.margin;
  options.event_hysteresis = params.event_hysteresis;
  options.finest_edge = params.finest_edge;
  options.threads = params.threads;
  options.world_limit = params.world_limit;
  options.growth_cap = params.growth_cap;
  options.growth_after = params.stale_after;
  options.max_bodies = static_cast<std::size_t>(params.max_bodies);
  options.max_pairs = static_cast<std::size_t>(params.max_pairs);
  options.max_reasons = static_cast<std::size_t>(params.max_reasons);
  options.required = params.required;
  options.pair_kinds = params.pair_kinds;
  options.allowed_pairs = params.allowed_pairs;
  options.pair_margins = params.pair_margins;
  options.horizon = params.horizon;
  options.report_unmapped = params.map_unknown == UnknownSpace::report;
  return options;
}

}  // namespace

World::Member World::memberOf(BodyId body, const Pose& frame_from_body) {
  return {body, frame_from_body.matrix() == Pose::Identity().matrix(), frame_from_body};
}

/// A body of the mover that was added last.
void World::Change::join(const Body& body, const Pose& frame_from_body) {
  in.push_back(body);
  members.push_back(memberOf({}, frame_from_body));
  movers.back().last = members.size();
}

/// A mover with one body.
void World::Change::add(const std::string& frame, const std::string& robot, const Body& body,
                        const Pose& frame_from_body) {
  Mover mover;
  mover.frame = frame;
  mover.robot = robot;
  mover.first = mover.last = members.size();
  movers.push_back(std::move(mover));
  join(body, frame_from_body);
}

World::World(const Params& params, bool simulated, std::uint64_t epoch, Ledger& ledger,
             std::shared_ptr<NarrowPhase> narrow_phase)
    : params_(params),
      ledger_(ledger),
      narrow_phase_(std::move(narrow_phase)),
      intake_(params.max_future, params.tf_cache, static_cast<std::size_t>(params.max_frames), simulated, ledger),
      poses_(intake_, params.max_sync_wait),
      watch_(simulated, params.clock_jump, params.stale_after),
      scene_(optionsOf(params)),
      map_news_(simulated),
      rules_(params.allowed_pairs),
      world_frame_(params.world_frame),
      epoch_(epoch) {
  scene_.beginEpoch(epoch_);
  for (const RobotParams& robot : params.robots) {
    missing_[robot.name] = "NOT_READY robot '" + robot.name + "': its description was not read yet";
  }
  for (const MapParams& map : params.maps) {
    missing_[joined("map", map.name)] =
        "NOT_READY map '" + map.name +
        "': " + (map.topic.empty() ? "its file was not read yet" : "nothing came on " + map.topic + " yet");
  }
  for (const CloudParams& cloud : params.clouds) {
    missing_[joined("cloud", cloud.name)] =
        "NOT_READY cloud '" + cloud.name + "': nothing came on " + cloud.topic + " yet";
  }
}

void World::beginEpoch() {
  scene_.beginEpoch(++epoch_);
  poses_.beginEpoch();
}

World::Change World::changeWithout(const std::function<bool(const std::string& robot)>& chosen) const {
  Change change;
  for (const Mover& mover : movers_) {
    const auto first = members_.begin() + static_cast<std::ptrdiff_t>(mover.first);
    const auto last = members_.begin() + static_cast<std::ptrdiff_t>(mover.last);
    if (chosen(mover.robot)) {
      for (auto member = first; member != last; ++member) change.out.push_back(member->body);
      continue;
    }
    change.movers.push_back(mover);
    change.movers.back().first = change.members.size();
    change.members.insert(change.members.end(), first, last);
    change.movers.back().last = change.members.size();
  }
  return change;
}

/// Puts the change into the world: all of it or nothing.
void World::exchange(Change change) {
  const std::vector<BodyId> ids = scene_.exchange(change.out, std::move(change.in));
  // Nothing below allocates.
  auto member = change.members.end() - static_cast<std::ptrdiff_t>(ids.size());
  for (const BodyId id : ids) (member++)->body = id;
  movers_.swap(change.movers);
  members_.swap(change.members);
  movers_changed_ = true;
}

void World::setRobot(LoadedRobot robot) {
  const auto known = robots_.find(robot.name);
  const std::size_t before = known == robots_.end() ? 0 : known->second.bodies.size();
  if (scene_.size() - before + robot.bodies.size() > static_cast<std::size_t>(params_.max_bodies)) {
    throw Refusal(Code::limit, "robot '" + robot.name + "' has " + std::to_string(robot.bodies.size()) +
                                   " bodies, which would be more than ~max_bodies, " +
                                   std::to_string(params_.max_bodies));
  }
  Change change = changeWithout([&](const std::string& other) { return other == robot.name; });
  for (const LoadedRobot::Group& group : robot.groups) {
    bool first = true;
    for (const auto& [body, frame_from_body] : group.members) {
      if (std::exchange(first, false)) {
        change.add(group.frame, robot.name, robot.bodies[body], frame_from_body);
      } else {
        change.join(robot.bodies[body], frame_from_body);
      }
    }
  }
  std::map<std::string, std::string> gap;
  if (!robot.gap.empty()) gap.emplace(robot.name, "UNCOVERED " + robot.gap);
  const std::string name = robot.name;
  std::map<std::string, LoadedRobot> loaded;
  loaded.emplace(name, std::move(robot));
  std::shared_ptr<const ModelReport> report = reportWith(loaded.begin()->second);
  exchange(std::move(change));
  // Nothing below allocates.
  missing_.erase(name);
  missing_.merge(gap);
  robots_.erase(name);
  robots_.merge(loaded);
  report_ = std::move(report);
}

void World::setMissing(const std::string& name, const std::string& sentence) {
  const auto cloud = clouds_.find(name);
  if (cloud != clouds_.end()) {
    cloud->second.refused = sentence;
  } else if (maps_.count(name) != 0) {
    map_news_.noteRefused(name, sentence);
  } else if (robots_.count(name) == 0) {
    missing_.insert_or_assign(name, sentence);
  }
}

/// What a robot (by its name), an obstacle, a map or a cloud (by the names of their bodies) lacks.
SourceGap World::gapOf(const std::string& thing, const std::string& sentence) const {
  const std::size_t slash = thing.find('/');
  if (slash == std::string::npos) return {thing, joined(thing, "*"), sentence};
  return {thing.compare(0, slash, "obstacle") == 0 ? "obstacle" : thing, thing, sentence};
}

std::vector<SourceGap> World::gaps(const Moment& now) const {
  std::vector<SourceGap> gaps = map_news_.gaps(now);
  for (const auto& thing : missing_) gaps.push_back(gapOf(thing.first, thing.second));
  return gaps;
}

/// Warns of patterns that match nothing: a misspelled name in a parameter would otherwise go unnoticed.
void World::warnOfIdlePatterns(const RobotsByName& robots, ModelReport& report) const {
  std::vector<std::string> names;
  for (const auto& robot : robots) {
    for (const Body& body : robot.second->bodies) names.push_back(body.name);
  }
  for (const ObstacleParams& obstacle : params_.obstacles) names.push_back(obstacle.body.name);
  for (const CloudParams& cloud : params_.clouds) names.push_back(joined("cloud", cloud.name));
  const auto matchesNone = [](const std::vector<std::string>& all, const std::string& pattern) {
    return std::none_of(all.begin(), all.end(), [&](const std::string& name) { return matches(pattern, name); });
  };
  const auto check = [&](const std::string& parameter, const std::string& pattern) {
    if (pattern.rfind("map/", 0) == 0) return;  // these come and go
    if (matchesNone(names, pattern))
      report.warnings.push_back(parameter + ": '" + printable(pattern) + "' matches no body");
  };
  for (const PatternValue& value : params_.margins) check("~margins", value.pattern);
  for (const PatternValue& value : params_.padding) check("~padding", value.pattern);
  for (const PatternValue& value : params_.max_speed) check("~max_speed", value.pattern);
  for (const PatternValue& value : params_.map_self_filter) check("~map/self_filter", value.pattern);
  const auto checkOfLinks = [&](const std::string& parameter, const std::string& pattern) {
    if (matchesNone(report.without_collision, pattern)) check(parameter, pattern);
  };
  for (const Waiver& waiver : params_.accept_uncovered) checkOfLinks("~accept_uncovered", waiver.pattern);
  for (const std::string& pattern : params_.use_visual) checkOfLinks("~use_visual", pattern);
  for (const PairMargin& pair : params_.pair_margins) {
    check("~pair_margins", pair.first);
    check("~pair_margins", pair.second);
  }
  for (const PairRule& rule : params_.allowed_pairs) {
    check("~allowed_pairs", rule.first);
    check("~allowed_pairs", rule.second);
  }
}

/// The report of the world's robots, with this one in the place of the one of its name.
std::shared_ptr<const ModelReport> World::reportWith(const LoadedRobot& loaded) const {
  RobotsByName robots;
  for (const auto& known : robots_) robots[known.first] = &known.second;
  robots[loaded.name] = &loaded;
  auto report = std::make_shared<ModelReport>();
  for (const auto& named : robots) {
    const LoadedRobot& robot = *named.second;
    for (const Body& body : robot.bodies) {
      if (!body.covered) (body.waived ? report->waived : report->uncovered).push_back(body.name + ": " + body.note);
    }
    if (!robot.gap.empty()) report->uncovered.push_back(robot.gap);
    if (!robot.waived_gap.empty()) report->waived.push_back(robot.waived_gap);
    report->without_collision.insert(report->without_collision.end(), robot.without_collision.begin(),
                                     robot.without_collision.end());
    report->uses_visual.insert(report->uses_visual.end(), robot.uses_visual.begin(), robot.uses_visual.end());
    report->self_pairs.emplace_back(robot.name, robot.self_pairs);
    for (const std::string& warning : robot.warnings) report->warnings.push_back(robot.name + ": " + warning);
  }
  report->robots = robots.size();
  if (robots.size() == params_.robots.size()) warnOfIdlePatterns(robots, *report);
  return report;
}

/// Adds the configured obstacles. If that fails, the next call goes on with the obstacle that failed.
void World::addObstacles() {
  movers_.reserve(movers_.size() + params_.obstacles.size() - obstacles_done_);
  members_.reserve(members_.size() + params_.obstacles.size() - obstacles_done_);
  while (obstacles_done_ < params_.obstacles.size()) {
    const ObstacleParams& configured = params_.obstacles[obstacles_done_];
    try {
      addObstacle(configured);
      ++obstacles_done_;
    } catch (const Refusal& refusal) {
      missing_.insert_or_assign(configured.body.name, std::string(name(refusal.code())) + " " + refusal.what());
      ++obstacles_done_;
      ledger_.refuse("obstacles.refused", refusal);
    }
  }
}

/// Adds one obstacle: all of it or nothing. There is room for its mover.
void World::addObstacle(const ObstacleParams& configured) {
  Body body = configured.body;
  if (body.frame.empty()) body.frame = world_frame_;
  body.mobility = body.frame == world_frame_ ? Mobility::fixed : Mobility::moving;
  body.max_speed = lastMatch(params_.max_speed, body.name, params_.default_max_speed);
  applyPatterns(params_, body);
  makeSolids(*narrow_phase_, body);
  Mover mover;
  mover.frame = body.frame;
  mover.first = members_.size();
  mover.last = mover.first + 1;
  Member member = memberOf({}, body.frame_from_body);
  member.body = scene_.add(std::move(body));
  // Nothing below allocates.
  members_.push_back(member);
  movers_.push_back(std::move(mover));
  movers_changed_ = true;
}

void World::reset() {
  exchange(changeWithout([](const std::string& robot) { return robot.empty(); }));
  obstacles_done_ = 0;
  for (const ObstacleParams& obstacle : params_.obstacles) missing_.erase(obstacle.body.name);
  ledger_.clear();
  beginEpoch();
}

void World::setRules(std::vector<PairRule> rules) {
  rules_ = RuleBook(std::move(rules));
  rules_changed_ = true;
}

/// Gives the scene the rules in force. If that fails, the next tick does it.
void World::applyRules(const Moment& now) {
  if (rules_.expire(now.steady)) rules_changed_ = true;
  if (!rules_changed_) return;
  scene_.setRules(rules_.rules());
  rules_changed_ = false;
}

bool World::findWorldFrame() {
  if (world_frame_.empty()) {
    const auto first = robots_.find(params_.robots.front().name);
    if (first != robots_.end()) world_frame_ = first->second.root_frame;
  }
  return !world_frame_.empty();
}

void World::handleClock(const Moment& now) {
  const ClockWatch::Event event = watch_.look(now);
  intake_.ages().look(now, watch_.frozen());
  // A jump that an earlier tick failed to handle is handled now; a jump back asks for more than one ahead.
  if (clock_event_ != ClockWatch::Event::jumped_back && event != ClockWatch::Event::none) clock_event_ = event;
  if (clock_event_ == ClockWatch::Event::none) return;
  const bool back = clock_event_ == ClockWatch::Event::jumped_back;
  const Refusal jump(Code::clock, std::string("ROS time jumped ") + (back ? "back" : "ahead") + "; a new epoch begins");
  if (!watch_.simulated()) {
    intake_.restamp();
    restamp(now);
  } else if (back) {
    intake_.forgetMoving();
    restamp(now);
  }
  beginEpoch();
  clock_event_ = ClockWatch::Event::none;
  ledger_.refuse("clock", jump);
}

/// The clock was set: gives the poses in use stamps of the new time. Under /clock those poses belong to an earlier run
/// of the simulation.
void World::restamp(const Moment& now) {
  for (Mover& mover : movers_) {
    if (!mover.pose.exists() || mover.pose.settled()) continue;
    mover.pose.restamp(intake_.ages().read(now), now.ros, watch_.simulated());
    tellStamp(mover);
  }
}

/// Gives the bodies of the mover, where they are, the stamp of its pose.
void World::tellStamp(const Mover& mover) {
  for (std::size_t i = mover.first; i < mover.last; ++i) {
    const Pose same = scene_.poseOf(members_[i].body).world_from_body;
    scene_.place(members_[i].body, same, mover.pose.stamp());
  }
}

void World::planWays() {
  if (settled_revision_ != intake_.staticRevision()) unsettle();
  if (!movers_changed_ && !poses_.stale()) return;
  unsettle();
  std::vector<std::string> frames;
  for (const Mover& mover : movers_) frames.push_back(mover.frame);
  movers_changed_ = true;  // until the plan is complete
  poses_.plan(world_frame_, frames);
  movers_changed_ = false;
}

/// Places all bodies of the mover or, if one of them cannot be there, none.
void World::place(Mover& mover, const FramePoses::Found& found, bool moves) {
  try {
    const Pose world_from_frame = found.world_from_frame.pose();
    placed_.clear();
    for (std::size_t i = mover.first; i < mover.last; ++i) {
      const Member& member = members_[i];
      placed_.push_back(member.at_frame ? world_from_frame : world_from_frame * member.frame_from_body);
      scene_.checkPlace(member.body, placed_.back());
    }
    for (std::size_t i = mover.first; i < mover.last; ++i) {
      scene_.place(members_[i].body, placed_[i - mover.first], found.stamp);
    }
    if (moves) {
      mover.pose.renew(found.stamp, found.born);
    } else {
      mover.pose.settle(found.stamp);
    }
  } catch (const Refusal& refusal) {
    ledger_.refuse("pose.refused", refusal);
    mover.trouble = refusal;
  }
}

/// How far the mover's pose can be trusted now, after place().
Freshness World::judge(const Mover& mover, const ChainState& chain) const {
  const bool invalid = mover.trouble && mover.trouble->code() != Code::unknown_frame;
  const AgeLimits limits{params_.late_after, params_.stale_after, params_.lost_after};
  const Freshness by_age = mover.pose.state(poses_.reading(), poses_.tickTime(), chain.period, limits);
  if (by_age == Freshness::frozen || (watch_.frozen() && !mover.settled)) return Freshness::frozen;
  return invalid ? Freshness::invalid : by_age;
}

void World::setState(const Mover& mover, Freshness state, double age) {
  for (std::size_t i = mover.first; i < mover.last; ++i) {
    std::uint32_t cohort = 0;  // of what stands still, since it keeps its number while those of the others change
    if (!mover.settled) {
      const Time stamp = scene_.poseOf(members_[i].body).stamp;
      cohort = cohorts_.emplace(stamp, static_cast<std::uint32_t>(cohorts_.size() + 1)).first->second;
    }
    scene_.setState(members_[i].body, state, age, cohort);
  }
}

void World::describeTrouble(const Mover& mover, Tick& tick) const {
  for (std::size_t i = mover.first; i < mover.last; ++i) {
    const BodyPose& pose = scene_.poseOf(members_[i].body);
    if (pose.state == Freshness::fresh && !mover.conflict) continue;
    const Body& body = scene_.body(members_[i].body);
    BodyTrouble trouble{body.name, body.frame, pose.state, pose.age, pose.stamp, Code::tf_timeout, {}};
    if (mover.trouble) {
      trouble.code = mover.trouble->code();
      trouble.sentence = mover.trouble->what();
    } else if (pose.state == Freshness::fresh) {
      trouble.code = Code::conflict;
      trouble.sentence = "a frame between '" + mover.frame + "' and '" + world_frame_ +
                         "' comes on /tf and on /tf_static; it must come on one of them";
    } else if (pose.state == Freshness::frozen) {
      trouble.code = Code::clock;
      trouble.sentence = "the clock stands still or jumped; nothing new came since";
    } else {
      trouble.sentence = "frame '" + mover.frame + "' is " + secondsText(pose.age) + " old";
    }
    if (pose.state == Freshness::unplaced) trouble.age = std::numeric_limits<double>::quiet_NaN();
    tick.troubles.push_back(std::move(trouble));
  }
}

/// A new way or a new transform on /tf_static may put elsewhere what stood still.
void World::unsettle() {
  for (Mover& mover : movers_) mover.settled = false;
  settled_revision_ = intake_.staticRevision();
}

void World::update(std::size_t index, Tick& tick) {
  Mover& mover = movers_[index];
  const ChainState& chain = poses_.chain(index);
  const bool stands = chain.connected && !chain.moves && chain.refused == nullptr && chain.contested == TfIntake::kNone;
  if (mover.settled && stands) return;
  mover.trouble = poses_.troubleOf(index);
  mover.conflict = chain.conflict;
  if (mover.pose.settled() && (!chain.connected || chain.moves)) {
    mover.pose.unsettle(poses_.tickTimeBefore(), poses_.readingBefore());
    tellStamp(mover);
  }
  if (const auto found = poses_.find(index, mover.pose)) place(mover, *found, chain.moves);
  if (!mover.pose.exists() && !poses_.unknownFrame(index).empty()) {
    tick.missing_frames.push_back(poses_.unknownFrame(index));
  }
  mover.settled = stands && !mover.trouble;
  setState(mover, judge(mover, chain), mover.pose.age(poses_.reading()));
  describeTrouble(mover, tick);
}

std::shared_ptr<const Tick> World::tick(const Moment& now) {
  auto tick = std::make_shared<Tick>();
  handleClock(now);
  applyRules(now);
  tick->made = now;
  tick->epoch = epoch_;
  const bool has_frame = findWorldFrame();
  if (has_frame && watch_.running()) addObstacles();  // before what is missing is listed: some may be refused
  tick->world_frame = world_frame_;
  std::vector<SourceGap> lacking = gaps(now);
  for (const SourceGap& gap : lacking) tick->not_ready.push_back(gap.sentence);
  tick->models = report_;
  tick->frames = intake_.frames();
  if (!watch_.running())
    tick->not_ready.push_back("NOT_READY: there is no time yet; /use_sim_time is set and /clock is silent");
  if (!has_frame) tick->not_ready.push_back("NOT_READY: the world frame is the root of a robot that is not loaded yet");
  if (!has_frame || !watch_.running()) return tick;

  const auto begin = std::chrono::steady_clock::now();
  planWays();
  poses_.look(now);
  const Time time = poses_.tickTime();
  cohorts_.clear();
  for (std::size_t i = 0; i < movers_.size(); ++i) update(i, *tick);
  tick->contested_frames = intake_.claims().sentences(poses_.reading());
  updateClouds(time, now, *tick, lacking);
  std::stable_sort(tick->troubles.begin(), tick->troubles.end(),
                   [](const BodyTrouble& a, const BodyTrouble& b) { return a.state > b.state; });
  std::sort(tick->missing_frames.begin(), tick->missing_frames.end());
  tick->missing_frames.erase(std::unique(tick->missing_frames.begin(), tick->missing_frames.end()),
                             tick->missing_frames.end());
  tick->poses_time = std::chrono::steady_clock::now() - begin;
  tick->snapshot = scene_.commit(time, lacking);
  tick->times = scene_.lastTimes();
  return tick;
}

}  // namespace hgrid
