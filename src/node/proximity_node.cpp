// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "proximity_node.h"

#include <ros/names.h>

#include <future>
#include <optional>
#include <utility>

#include "distances_messages.h"
#include "hgrid_proximity/adapters/fcl.h"
#include "hgrid_proximity/scene/name.h"
#include "map_markers.h"

namespace hgrid {
namespace {

constexpr auto kGrace = std::chrono::seconds(1);         // after the start
constexpr auto kJobPatience = std::chrono::seconds(10);  // a tick takes milliseconds; longer means that it hangs

Moment thisMoment() {
  Moment moment;
  moment.ros = Time(static_cast<std::int64_t>(ros::Time::now().toNSec()));
  moment.steady = std::chrono::steady_clock::now();
  return moment;
}

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
      robot_source_(private_node, params_, narrow_phase_),
      world_(params_, ros::Time::isSimTime(), newEpoch(), ledger_, narrow_phase_),
      own_shapes_(params_, world_.transforms().buffer(), [this] { return newest(); }),
      map_source_(params_, own_shapes_, narrow_phase_, ledger_),
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

  const auto on_tf = [this](bool is_static) {
    return boost::function<void(const ros::MessageEvent<tf2_msgs::TFMessage const>&)>(
        [this, is_static](const ros::MessageEvent<tf2_msgs::TFMessage const>& event) {
          onTransforms(event, is_static);
        });
  };
  subscribers_.push_back(update_node_.subscribe<tf2_msgs::TFMessage>("/tf", 1000, on_tf(false), ros::VoidConstPtr(),
                                                                     ros::TransportHints().tcpNoDelay()));
  subscribers_.push_back(update_node_.subscribe<tf2_msgs::TFMessage>("/tf_static", 1000, on_tf(true)));

  for (const MapParams& map : params_.maps) {
    if (map.topic.empty()) continue;
    const boost::function<void(const boost::shared_ptr<const OctomapMessage>&)> on_map =
        [this, map](const boost::shared_ptr<const OctomapMessage>& message) { onMap(map, *message); };
    subscribers_.push_back(admin_node_.subscribe<OctomapMessage>(map.topic, 1, on_map));
  }

  queries_ = std::make_unique<QueryServices>(
      query_private_, params_, config_hash_, [this] { return newest(); }, world_.transforms().buffer(), narrow_phase_,
      sketch_, ledger_);
  explain_ = std::make_unique<ExplainService>(
      query_private_, params_, config_hash_, [this] { return newest(); }, narrow_phase_, ledger_);
  const AdminAnswer answer{params_, config_hash_, [this] { return newest(); },
                           [this](const Job& job) { return tickAfter(job); }, ledger_};
  allowed_ = std::make_unique<AllowedServices>(admin_private_, answer);
  maps_ = std::make_unique<MapServices>(admin_private_, map_source_, answer,
                                        [this](const std::string& map) { forgetPending(map); });
  servers_.push_back(admin_private_.advertiseService("reset", &ProximityNode::onReset, this));
  servers_.push_back(admin_private_.advertiseService("reload_robot", &ProximityNode::onReload, this));
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

void ProximityNode::onTransforms(const ros::MessageEvent<tf2_msgs::TFMessage const>& event, bool is_static) {
  const Moment now = thisMoment();
  world_.transforms().take(*event.getConstMessage(), is_static, event.getPublisherName(), now);
  tf_time_ += std::chrono::steady_clock::now() - now.steady;
}

void ProximityNode::onTick(const ros::SteadyTimerEvent& event) {
  try {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<Job> jobs;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      jobs.swap(jobs_);
      const bool late = event.current_real - event.current_expected > ros::WallDuration(1.0 / params_.rate);
      health_.late_ticks_in_a_row = late ? health_.late_ticks_in_a_row + 1 : 0;
      if (late) ledger_.count("tick.late");
    }
    for (const Job& job : jobs) job(world_);
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
  } catch (const std::exception& error) {  // the last tick goes on serving; its age shows that there is no newer one
    ledger_.refuse("tick.failed", Refusal(Code::internal, error.what()));
  }
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
  const bool complete = tick.snapshot && tick.snapshot->complete();
  std::string reason;
  if (!complete) reason = tick.snapshot ? tick.snapshot->reasons().front() : tick.not_ready.front();
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

void ProximityNode::runInTick(const Job& job) {
  const auto done = std::make_shared<std::promise<void>>();
  std::future<void> result = done->get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs_.push_back([job, done](World& world) {
      try {
        job(world);
        done->set_value();
      } catch (...) {
        done->set_exception(std::current_exception());
      }
    });
  }
  const auto deadline = std::chrono::steady_clock::now() + kJobPatience;
  while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
    if (stopping_ || std::chrono::steady_clock::now() > deadline) {
      throw Refusal(Code::busy, "no tick took this up within " + std::to_string(kJobPatience.count()) + " s");
    }
  }
  result.get();
}

Refusal ProximityNode::loadRobot(const RobotParams& robot) {
  Refusal result(Code::ok, "");
  SelfPairs self_pairs;
  try {
    const auto loaded = std::make_shared<LoadedRobot>(robot_source_.load(robot));
    self_pairs = loaded->self_pairs;
    runInTick([loaded](World& world) { world.setRobot(std::move(*loaded)); });
  } catch (const Refusal& refusal) {
    result = refusal;
  } catch (const std::exception& error) {
    result = Refusal(Code::internal, error.what());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (result.code() == Code::ok) {
    health_.failed_loads.erase(robot.name);
    logLoaded(robot.name, self_pairs);
    return result;
  }
  const std::string sentence = std::string(name(result.code())) + " robot '" + robot.name + "': " + result.what();
  if (health_.failed_loads[robot.name] != sentence) ROS_WARN("%s", sentence.c_str());
  health_.failed_loads[robot.name] = sentence;
  jobs_.push_back([robot, sentence](World& world) { world.setMissing(robot.name, sentence); });
  return result;
}

/// Puts what `load` returns into the world; says why if that fails.
Refusal ProximityNode::putMap(const MapParams& map, const std::function<LoadedMap()>& load) {
  Refusal result(Code::ok, "");
  try {
    const LoadedMap loaded = load();
    runInTick([loaded](World& world) { world.setMap(loaded); });
    return result;
  } catch (const Refusal& refusal) {
    result = refusal;
  } catch (const std::exception& error) {
    result = Refusal(Code::internal, error.what());
  }
  ledger_.refuse("maps.refused", result);
  const std::string sentence = std::string(name(result.code())) + " map '" + map.name + "': " + result.what();
  const std::lock_guard<std::mutex> lock(mutex_);
  jobs_.push_back([body = joined("map", map.name), sentence](World& world) { world.setMissing(body, sentence); });
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
  sink.miss = [this, body = joined("cloud", cloud.name)](const std::string& sentence) {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs_.push_back([body, sentence](World& world) { world.setMissing(body, sentence); });
  };
  clouds_.push_back(std::make_unique<CloudSource>(
      admin_node_, cloud, params_, own_shapes_, world_.transforms().buffer(), narrow_phase_,
      [this] { return newest(); }, sink, ledger_));
}

/// Tries again the robots that have no model and the maps without cells, at first often, then every ten seconds.
void ProximityNode::loadMissing() {
  const auto now = std::chrono::steady_clock::now();
  if ((to_load_.empty() && maps_to_load_.empty() && arrived_maps_.empty()) || now < next_try_) return;
  std::vector<std::string> left;
  for (const RobotParams& robot : params_.robots) {
    const bool wanted = std::find(to_load_.begin(), to_load_.end(), robot.name) != to_load_.end();
    if (wanted && loadRobot(robot).code() != Code::ok) left.push_back(robot.name);
  }
  to_load_ = left;
  const auto read = [this](const MapParams& map) {
    return putMap(map, [&] { return map_source_.finished(map_source_.read(map)); }).code() == Code::ok;
  };
  const auto taken = [this](const ReadMap& map) {
    return putMap(map.params, [&] { return map_source_.finished(map); }).code() == Code::ok;
  };
  maps_to_load_.erase(std::remove_if(maps_to_load_.begin(), maps_to_load_.end(), read), maps_to_load_.end());
  arrived_maps_.erase(std::remove_if(arrived_maps_.begin(), arrived_maps_.end(), taken), arrived_maps_.end());
  retry_after_ = std::min(10.0, std::max(0.5, 2.0 * retry_after_));
  next_try_ = now + std::chrono::milliseconds(static_cast<int>(1e3 * retry_after_));
}

void ProximityNode::onHousekeeping() {
  loadMissing();
  publishMarkers();
  const auto now = std::chrono::steady_clock::now();
  if (now < next_diagnostics_) return;
  next_diagnostics_ = now + std::chrono::seconds(1);
  diagnostics_->update();
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

bool ProximityNode::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    runInTick([this](World& world) {
      world.reset();
      stopwatch_ = Stopwatch();
    });
    waitForTick();
    response.success = true;
    response.message = "obstacles as configured, counters at 0, a new epoch";
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

bool ProximityNode::onReload(msg::ReloadRobot::Request& request, msg::ReloadRobot::Response& response) {
  response.code = toMsg(Code::ok, "");
  bool found = false;
  for (const RobotParams& robot : params_.robots) {
    if (!request.robot.empty() && robot.name != request.robot) continue;
    found = true;
    const Refusal result = loadRobot(robot);
    if (result.code() != Code::ok) {
      response.code = toMsg(result.code(), "robot '" + robot.name + "': " + result.what());
    } else {
      to_load_.erase(std::remove(to_load_.begin(), to_load_.end(), robot.name), to_load_.end());
    }
  }
  if (!found) {
    response.code = toMsg(Code::unknown_id, "there is no robot '" + printable(request.robot) + "' in ~robots");
  }
  response.success = response.code.value == msg::Code::OK;
  try {
    waitForTick();
  } catch (const Refusal& refusal) {
    ledger_.refuse("reload", refusal);
  }
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
