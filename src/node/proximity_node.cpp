// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/proximity_node.h"

#include <hgrid_proximity/CodeNames.h>
#include <ros/init.h>
#include <ros/names.h>

#include <future>
#include <optional>
#include <utility>

#include "hgrid_proximity/adapters/fcl.h"
#include "hgrid_proximity/bodies/name.h"
#include "node/messages/distances_messages.h"
#include "node/messages/map_markers.h"
#include "node/services/guarded.h"

namespace hgrid {
namespace {

constexpr auto kGrace = std::chrono::seconds(1);         // after the start
constexpr double kShareForTransforms = 0.5;              // of a period: a flood of transforms does not stop the ticks
constexpr auto kJobPatience = std::chrono::seconds(10);  // a tick takes milliseconds; longer means that it hangs

XmlRpc::XmlRpcValue valuesOf(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue values;
  if (!node.getParam(node.getNamespace(), values) || values.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    values = XmlRpc::XmlRpcValue();
    values.begin();  // an empty dictionary: nothing was set
  }
  return values;
}

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

std::uint64_t newEpoch() {
  return static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
}

void logLoaded(const std::string& robot, const SelfPairs& self_pairs) {
  const std::string line = "Robot '" + robot + "' is loaded: " + text(self_pairs) + ".";
  if (self_pairs.allOff()) {
    ROS_WARN("%s", line.c_str());
  } else {
    ROS_INFO("%s", line.c_str());
  }
}

ros::NodeHandle onQueue(ros::NodeHandle node, ros::CallbackQueue& queue) {
  node.setCallbackQueue(&queue);
  return node;
}

}  // namespace

ProximityNode::ProximityNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : ProximityNode(node, private_node, makeFclNarrowPhase()) {}

ProximityNode::ProximityNode(ros::NodeHandle node, ros::NodeHandle private_node,
                             std::shared_ptr<NarrowPhase> narrow_phase)
    : update_node_(onQueue(node, update_queue_)),
      update_private_(onQueue(private_node, update_queue_)),
      query_private_(onQueue(private_node, query_queue_)),
      admin_node_(onQueue(node, admin_queue_)),
      admin_private_(onQueue(private_node, admin_queue_)),
      params_(readParams(valuesOf(private_node))),
      config_hash_(fnv1a(valuesOf(private_node).toXml())),
      narrow_phase_(std::move(narrow_phase)),
      robot_source_(private_node, params_, narrow_phase_, [this] { return isEnding(); }),
      world_(params_, ros::Time::isSimTime(), newEpoch(), ledger_, narrow_phase_),
      self_shapes_(params_, world_.transforms().lookup(), [this] { return newest(); }),
      map_source_(params_, self_shapes_, narrow_phase_, ledger_),
      meter_(narrow_phase_, {params_.distances_max, params_.distances_budget, params_.distances_threads}) {
  for (const RobotParams& robot : params_.robots) to_load_.push_back(robot.name);
  for (const MapParams& map : params_.maps) {
    if (!map.file.empty()) maps_to_load_.push_back(map);
  }

  pairs_ = update_private_.advertise<msg::Pairs>("pairs", 1);
  distances_ = update_private_.advertise<msg::Distances>("distances", 1);
  events_ = update_private_.advertise<msg::Events>("events", static_cast<std::uint32_t>(params_.event_queue));
  status_ = update_private_.advertise<msg::Status>("status", 1);
  bodies_ = update_private_.advertise<msg::Bodies>("bodies", 1, true);
  markers_ = admin_private_.advertise<visualization_msgs::MarkerArray>("markers", 1);

  transforms_ = std::make_unique<TfReader>(
      update_node_, static_cast<std::size_t>(params_.tf_queue_bytes), thisMoment,
      [this](const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher, const Moment& received) {
        guarded(ledger_, "tf.failed", [&] { takeTransforms(message, is_static, publisher, received); });
      },
      ledger_);

  for (const MapParams& map : params_.maps) {
    if (map.topic.empty()) continue;
    const boost::function<void(const boost::shared_ptr<const OctomapMessage>&)> on_map =
        [this, map](const boost::shared_ptr<const OctomapMessage>& message) {
          guarded(ledger_, "maps.failed", [&] { onMap(map, *message); });
        };
    subscribers_.push_back(admin_node_.subscribe<OctomapMessage>(map.topic, 1, on_map));
  }

  queries_ = std::make_unique<QueryServices>(
      query_private_, params_, config_hash_, [this] { return newest(); }, world_.transforms().lookup(), narrow_phase_,
      sketch_, ledger_);
  explain_ = std::make_unique<ExplainService>(
      query_private_, params_, config_hash_, [this] { return newest(); }, narrow_phase_, ledger_);
  const AdminAnswer answer{params_, config_hash_, [this] { return newest(); },
                           [this](const Job& job) { return tickAfter(job); }, ledger_};
  allowed_ = std::make_unique<AllowedServices>(admin_private_, answer);
  maps_ = std::make_unique<MapServices>(admin_private_, map_source_, answer,
                                        [this](const std::string& map) { forgetPending(map); });
  servers_.push_back(advertiseGuarded(admin_private_, "reset", &ProximityNode::onReset, this, ledger_));
  servers_.push_back(advertiseGuarded(admin_private_, "reload_robot", &ProximityNode::onReload, this, ledger_));
  diagnostics_ = std::make_unique<NodeDiagnostics>(
      admin_node_, admin_private_, private_node.getNamespace(), [this] { return newest(); },
      [this] { return health(); });

  tick_timer_ = update_node_.createSteadyTimer(ros::WallDuration(1.0 / params_.rate), &ProximityNode::onTick, this);
  housekeeping_timer_ = admin_node_.createSteadyTimer(ros::WallDuration(std::min(0.25, 1.0 / params_.marker_rate)),
                                                      [this](const ros::SteadyTimerEvent&) { onHousekeeping(); });

  spinners_.push_back(std::make_unique<ros::AsyncSpinner>(1, &update_queue_));
  spinners_.push_back(
      std::make_unique<ros::AsyncSpinner>(static_cast<std::uint32_t>(params_.query_threads), &query_queue_));
  spinners_.push_back(std::make_unique<ros::AsyncSpinner>(1, &admin_queue_));
  for (const auto& spinner : spinners_) spinner->start();
  for (const CloudParams& cloud : params_.clouds) addCloud(cloud);
}

ProximityNode::~ProximityNode() {
  stopping_ = true;
  tick_timer_.stop();
  housekeeping_timer_.stop();
  clouds_.clear();
  for (const auto& spinner : spinners_) spinner->stop();
}

void ProximityNode::takeTransforms(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                                   const Moment& received) {
  const auto begin = std::chrono::steady_clock::now();
  world_.transforms().take(message, is_static, publisher, received);
  tf_time_ += std::chrono::steady_clock::now() - begin;
}

/// Makes a tick. If that fails, the last tick goes on serving; its age shows that there is no newer one.
void ProximityNode::onTick(const ros::SteadyTimerEvent& event) {
  const std::optional<Refusal> fault = guarded(ledger_, "tick.failed", [&] { makeTick(event); });
  const std::lock_guard<std::mutex> lock(mutex_);
  health_.failed_tick = fault;
  if (fault) ++health_.failed_ticks;
}

void ProximityNode::makeTick(const ros::SteadyTimerEvent& event) {
  transforms_->readFor(std::chrono::duration<double>(kShareForTransforms / params_.rate));
  const auto begin = std::chrono::steady_clock::now();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool late = event.current_real - event.current_expected > ros::WallDuration(1.0 / params_.rate);
    health_.late_ticks_in_a_row = late ? health_.late_ticks_in_a_row + 1 : 0;
    if (late) ledger_.count("tick.late");
  }
  jobs_.doAll(world_, ledger_);
  const std::shared_ptr<const Tick> tick = world_.tick(thisMoment());
  std::atomic_store(&newest_, tick);
  const auto made = std::chrono::steady_clock::now();
  publish(tick);
  const auto published = std::chrono::steady_clock::now();
  measure(tick);
  const auto measured = std::chrono::steady_clock::now();
  logChange(*tick);
  noteConflicts();
  const auto end = std::chrono::steady_clock::now();
  stopwatch_.add("tick", end - begin);
  stopwatch_.add("tick.poses", tick->poses_time);
  stopwatch_.add("tick.boxes", tick->times.boxes);
  stopwatch_.add("tick.grid", tick->times.grid);
  stopwatch_.add("tick.pairs", tick->times.pairs);
  stopwatch_.add("tick.publish", published - made);
  stopwatch_.add("tick.distances", measured - published);
  stopwatch_.add("tf", std::exchange(tf_time_, std::chrono::nanoseconds(0)));
  stopwatch_.summarise(end);
}

/// Conflicts never go away, so their number says whether there are new ones.
void ProximityNode::noteConflicts() {
  const std::vector<std::string>& conflicts = world_.transforms().conflicts();
  if (conflicts.size() == known_conflicts_) return;
  known_conflicts_ = conflicts.size();
  const std::lock_guard<std::mutex> lock(mutex_);
  health_.conflicts = conflicts;
}

void ProximityNode::publish(const std::shared_ptr<const Tick>& tick) {
  const msg::WorldState world = worldState(*tick, params_, config_hash_, 0.0);
  if (events_.getNumSubscribers() > 0) {  // before what says how many there were
    for (const auto& message : eventsMessages(*tick, world, params_, *narrow_phase_)) events_.publish(message);
  }
  if (pairs_.getNumSubscribers() > 0) pairs_.publish(pairs_messages_.of(*tick, world));
  if (status_.getNumSubscribers() > 0) {
    status_.publish(boost::make_shared<msg::Status>(status(*tick, world, params_, ledger_, stopwatch_)));
  }
  if (world.bodies_revision != published_revision_ || tick->epoch != published_epoch_) {
    published_revision_ = world.bodies_revision;
    published_epoch_ = tick->epoch;
    bodies_.publish(boost::make_shared<msg::Bodies>(bodies(*tick)));
  }
}

/// Exact distances, once the candidates are out: those who need no more do not wait for them.
void ProximityNode::measure(const std::shared_ptr<const Tick>& tick) {
  const bool wanted = distances_.getNumSubscribers() > 0;
  if (!wanted && markers_.getNumSubscribers() == 0) return std::atomic_store(&measured_, {});
  auto measured = std::make_shared<MeasuredTick>();
  measured->tick = tick;
  if (tick->snapshot) measured->distances = meter_.measure(*tick->snapshot);
  std::atomic_store(&measured_, std::shared_ptr<const MeasuredTick>(measured));
  if (!wanted) return;
  const msg::WorldState world = worldState(*tick, params_, config_hash_, 0.0);
  distances_.publish(distancesMessage(*tick, world, measured->distances.get(), params_));
  if (!measured->distances) return;
  if (measured->distances->left_out > 0) ledger_.count("distances.left_out", measured->distances->left_out);
  if (measured->distances->failed > 0) ledger_.count("distances.failed", measured->distances->failed);
}

/// One line when the world becomes complete or stops being so, or for another reason; not one per tick.
void ProximityNode::logChange(const Tick& tick) {
  const bool complete = tick.snapshot && tick.snapshot->complete() && !tick.snapshot->truncated();
  std::string reason;
  if (!tick.snapshot) {
    reason = tick.not_ready.front();
  } else if (!complete) {
    reason = tick.snapshot->complete() ? truncationOf(*tick.snapshot) : tick.snapshot->reasons().front();
  }
  // The age in a sentence changes every tick; what comes before it names the thing.
  const std::string gist = reason.substr(0, reason.find(':'));
  if (complete == was_complete_ && gist == last_reason_) return;
  if (!complete && tick.made.steady - started_ < kGrace) return;  // what is not there yet may just be starting too
  if (complete) {
    ROS_INFO("The world is complete: %zu bodies in frame '%s'.", tick.snapshot->poses().size(),
             tick.world_frame.c_str());
  } else {
    ROS_WARN_THROTTLE(1.0, "The world is not complete: %s", reason.c_str());
  }
  was_complete_ = complete;
  last_reason_ = gist;
}

/// Whether the node or its process is about to end, so that nothing may take long any more.
bool ProximityNode::isEnding() const { return stopping_ || ros::isShuttingDown(); }

/// Does a job at the begin of a tick and waits for it. @throws what the job throws; Refusal busy if no tick comes
void ProximityNode::runInTick(const Job& job) {
  const auto done = std::make_shared<std::promise<void>>();
  std::future<void> result = done->get_future();
  jobs_.add([job, done](World& world) {
    try {
      job(world);
      done->set_value();
    } catch (...) {
      done->set_exception(std::current_exception());
    }
  });
  const auto deadline = std::chrono::steady_clock::now() + kJobPatience;
  while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (isEnding()) throw Refusal(Code::busy, "the node is about to end; it changes nothing any more");
    if (std::chrono::steady_clock::now() > deadline) {
      throw Refusal(Code::busy, "no tick took this up within " + std::to_string(kJobPatience.count()) + " s");
    }
  }
  result.get();
}

/// Has the next tick say why a robot, map or cloud is not in the world, or not as the newest data has it.
void ProximityNode::noteMissing(const SourceId& source, const std::string& sentence) {
  jobs_.add([source, sentence](World& world) { world.setMissing(source, sentence); });
}

Refusal ProximityNode::loadRobot(const RobotParams& robot) {
  Refusal result(Code::ok, "");
  SelfPairs self_pairs;
  try {
    const auto loaded = std::make_shared<LoadedRobot>(robot_source_.load(robot));
    self_pairs = loaded->self_pairs;
    runInTick([loaded](World& world) { world.setRobot(std::move(*loaded)); });
  } catch (...) {
    result = caughtRefusal();
  }
  if (result.code() == Code::ok) {
    const std::lock_guard<std::mutex> lock(mutex_);
    health_.failed_loads.erase(robot.name);
    logLoaded(robot.name, self_pairs);
    return result;
  }
  const std::string sentence = std::string(name(result.code())) + " robot '" + robot.name + "': " + result.what();
  noteMissing(SourceId::ofRobot(robot.name), sentence);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (health_.failed_loads[robot.name] != sentence) ROS_WARN("%s", sentence.c_str());
  health_.failed_loads[robot.name] = sentence;
  return result;
}

/// Puts what `load` returns into the world; says why if that fails.
Refusal ProximityNode::putMap(const MapParams& map, const std::function<LoadedMap()>& load) {
  Refusal result(Code::ok, "");
  try {
    const LoadedMap loaded = load();
    runInTick([loaded](World& world) { world.setMap(loaded); });
    return result;
  } catch (...) {
    result = caughtRefusal();
  }
  noteMissing(SourceId::ofMap(map.name),
              std::string(name(result.code())) + " map '" + map.name + "': " + result.what());
  ledger_.refuse("maps.refused", result);
  return result;
}

/// A map that comes before there is a world waits for it: many are sent but once.
void ProximityNode::onMap(const MapParams& map, const OctomapMessage& message) {
  std::optional<ReadMap> read;
  const Refusal result = putMap(map, [&] {
    read = map_source_.read(map, message);
    return map_source_.finished(*read);
  });
  const auto same = [&](const ReadMap& other) { return other.params.name == map.name; };
  arrived_maps_.erase(std::remove_if(arrived_maps_.begin(), arrived_maps_.end(), same), arrived_maps_.end());
  if (read && result.code() != Code::ok) arrived_maps_.push_back(std::move(*read));
}

/// Maps that were to be put into the world later are not, since somebody has decided what it has.
void ProximityNode::forgetPending(const std::string& map) {
  const auto chosen = [&](const MapParams& params) { return map.empty() || params.name == map; };
  maps_to_load_.erase(std::remove_if(maps_to_load_.begin(), maps_to_load_.end(), chosen), maps_to_load_.end());
  arrived_maps_.erase(std::remove_if(arrived_maps_.begin(), arrived_maps_.end(),
                                     [&](const ReadMap& arrived) { return chosen(arrived.params); }),
                      arrived_maps_.end());
}

void ProximityNode::addCloud(const CloudParams& cloud) {
  CloudSource::Sink sink;
  sink.put = [this](const LoadedCloud& loaded) { runInTick([loaded](World& world) { world.setCloud(loaded); }); };
  sink.miss = [this, source = SourceId::ofCloud(cloud.name)](const std::string& sentence) {
    noteMissing(source, sentence);
  };
  clouds_.push_back(std::make_unique<CloudSource>(
      admin_node_, cloud, params_, self_shapes_, world_.transforms().lookup(), narrow_phase_,
      [this] { return newest(); }, sink, ledger_));
}

/// Tries again the robots that have no model and the maps without cells, at first often, then every ten seconds.
void ProximityNode::loadMissing() {
  const auto now = std::chrono::steady_clock::now();
  if ((to_load_.empty() && maps_to_load_.empty() && arrived_maps_.empty()) || now < next_try_) return;
  retry_after_ = std::min(10.0, std::max(0.5, 2.0 * retry_after_));
  next_try_ = now + std::chrono::milliseconds(static_cast<int>(1e3 * retry_after_));
  std::vector<std::string> left;
  for (const RobotParams& robot : params_.robots) {
    const bool wanted = std::find(to_load_.begin(), to_load_.end(), robot.name) != to_load_.end();
    if (wanted && loadRobot(robot).code() != Code::ok) left.push_back(robot.name);
  }
  to_load_ = left;
  const auto succeeds = [this](const MapParams& map, const std::function<LoadedMap()>& load) {
    bool done = false;
    guarded(ledger_, "maps.failed", [&] { done = putMap(map, load).code() == Code::ok; });
    return done;
  };
  const auto read = [&](const MapParams& map) {
    return succeeds(map, [&] { return map_source_.finished(map_source_.read(map)); });
  };
  const auto taken = [&](const ReadMap& map) {
    return succeeds(map.params, [&] { return map_source_.finished(map); });
  };
  maps_to_load_.erase(std::remove_if(maps_to_load_.begin(), maps_to_load_.end(), read), maps_to_load_.end());
  arrived_maps_.erase(std::remove_if(arrived_maps_.begin(), arrived_maps_.end(), taken), arrived_maps_.end());
}

/// Each part is guarded by itself, so that a fault in one of them leaves the others.
void ProximityNode::onHousekeeping() {
  guarded(ledger_, "loading.failed", [&] { loadMissing(); });
  guarded(ledger_, "markers.failed", [&] { publishMarkers(); });
  const auto now = std::chrono::steady_clock::now();
  if (now < next_diagnostics_) return;
  next_diagnostics_ = now + std::chrono::seconds(1);
  guarded(ledger_, "diagnostics.failed", [&] { diagnostics_->update(); });
}

void ProximityNode::publishMarkers() {
  const std::size_t viewers = markers_.getNumSubscribers();
  const std::shared_ptr<const Tick> tick = newest();
  if (viewers > 0 && tick) {
    if (viewers > viewers_) markers_.publish(markersGone(*tick));
    const std::shared_ptr<const MeasuredTick> measured = std::atomic_load(&measured_);
    const bool has_distances = measured && measured->distances;
    const Tick& shown = has_distances ? *measured->tick : *tick;
    visualization_msgs::MarkerArray array =
        markers(shown, sketch_, has_distances ? measured->distances.get() : nullptr);
    const std::vector<visualization_msgs::Marker> cells = mapMarkers(shown, params_);
    array.markers.insert(array.markers.end(), cells.begin(), cells.end());
    markers_.publish(array);
  }
  viewers_ = viewers;
}

/// Waits until a tick is out that has all that was done before this call.
void ProximityNode::waitForTick() {
  runInTick([](World&) {});
  runInTick([](World&) {});
}

/// Does a job at the begin of a tick and returns that tick.
std::shared_ptr<const Tick> ProximityNode::tickAfter(const Job& job) {
  runInTick(job);
  const auto tick = std::make_shared<std::shared_ptr<const Tick>>();  // not on the stack: the wait may be given up
  runInTick([this, tick](World&) { *tick = newest(); });
  return *tick;
}

bool ProximityNode::onReset(Checked<std_srvs::Trigger::Request>& checked, std_srvs::Trigger::Response& response) {
  try {
    checked.value();
    runInTick([this](World& world) {
      world.reset();
      stopwatch_ = Stopwatch();
    });
    waitForTick();
    response.success = true;
    response.message = "obstacles as configured, counters at 0, a new epoch";
  } catch (...) {
    const Refusal refusal = caughtRefusal();
    ledger_.refuse("reset.refused", refusal);
    response.message = std::string(name(refusal.code())) + ": " + refusal.what();
  }
  return true;
}

/// Loads a robot's description again, or those of all robots if the name is empty. Returns after the tick that has
/// them.
/// @returns OK, or why the last robot that failed keeps its old model
msg::Code ProximityNode::reload(const std::string& robot_name) {
  msg::Code code = toMsg(Code::ok, "");
  bool found = false;
  for (const RobotParams& robot : params_.robots) {
    if (!robot_name.empty() && robot.name != robot_name) continue;
    found = true;
    const Refusal result = loadRobot(robot);
    if (result.code() != Code::ok) {
      code = toMsg(result.code(), "robot '" + robot.name + "': " + result.what());
    } else {
      to_load_.erase(std::remove(to_load_.begin(), to_load_.end(), robot.name), to_load_.end());
    }
  }
  if (!found) code = toMsg(Code::unknown_id, "there is no robot '" + printable(robot_name) + "' in ~robots");
  try {
    waitForTick();
  } catch (...) {
    ledger_.refuse("reload", caughtRefusal());
  }
  return code;
}

bool ProximityNode::onReload(Checked<msg::ReloadRobot::Request>& checked, msg::ReloadRobot::Response& response) {
  try {
    response.code = reload(checked.value().robot);
  } catch (const Refusal& refusal) {
    ledger_.refuse("reload_robot.refused", refusal);
    response.code = toMsg(refusal.code(), refusal.what());
  }
  response.success = response.code.value == msg::CodeNames::OK;
  if (const auto tick = newest()) {
    response.world = worldState(*tick, params_, config_hash_, 0.0);
    response.uncovered = tick->models->uncovered;
    response.warnings = tick->models->warnings;
  }
  return true;
}

NodeHealth ProximityNode::health() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return health_;
}

}  // namespace hgrid
