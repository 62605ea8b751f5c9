// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/pairs/rule_book.h"
#include "hgrid_proximity/world/scene.h"
#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/sources/loaded_map.h"
#include "node/sources/map_news.h"
#include "node/sources/robot_source.h"
#include "node/tf/clock_watch.h"
#include "node/tf/frame_poses.h"
#include "node/tf/kept_pose.h"
#include "node/tf/tf_intake.h"

namespace hgrid {

/// A body that is not as it should be.
struct BodyTrouble {
  std::string name, frame;
  Freshness state;
  double age;  // [s]; NaN if it never had a pose
  Time stamp;
  Code code;
  std::string sentence;
};

/// What the descriptions of the robots lack and what their models switch off; changes with the bodies only.
struct ModelReport {
  std::vector<std::string> uncovered, waived, without_collision, uses_visual, warnings;
  std::vector<std::pair<std::string, SelfPairs>> self_pairs;  // by robot
  std::size_t robots = 0;
};

/// The result of one tick: what every message and every answer is made from. Immutable.
struct Tick {
  std::shared_ptr<const Snapshot> snapshot;  // null: there is no world yet, not_ready says why
  std::string world_frame;
  Moment made;
  std::uint64_t epoch = 0;
  std::vector<std::string> not_ready;
  std::vector<BodyTrouble> troubles;  // the worst first
  std::vector<std::string> missing_frames;
  std::vector<std::string> contested_frames;  // a sentence for each frame over which publishers fight
  std::shared_ptr<const ModelReport> models;
  TickTimes times;
  std::size_t frames = 0;  // that tf knows
  std::chrono::nanoseconds poses_time{0};
};

/// A tick and the exact distances of its pairs.
struct MeasuredTick {
  std::shared_ptr<const Tick> tick;
  std::shared_ptr<const PairDistances> distances;
};

/// Keeps the Scene up to date: gives it the poses that FramePoses finds, and says how far each can be trusted. One
/// thread writes; any thread may read a Tick.
///
/// A call that throws, also for lack of memory, has changed nothing. tick() may throw for lack of memory; the next tick
/// is right.
class World {
 public:
  World(const Params& params, bool simulated, std::uint64_t epoch, Ledger& ledger,
        std::shared_ptr<NarrowPhase> narrow_phase);

  TfIntake& transforms() { return intake_; }
  const TfIntake& transforms() const { return intake_; }

  /// Puts a robot in the place of the one of the same name; all of it or, with a Refusal, nothing.
  void setRobot(LoadedRobot robot);
  /// Puts a map in the place of the one of the same name. @throws Refusal not_ready (no world frame yet), limit,
  /// unknown_frame (the old one is known where it is, the new one is not)
  void setMap(const LoadedMap& map);
  /// Takes a map away, or waits for it no more; an empty name all of them. @throws Refusal unknown_id
  void clearMap(const std::string& name);
  /// Puts what a sensor has seen in the place of what it saw before. @throws Refusal limit
  void setCloud(const LoadedCloud& cloud);
  /// Says why a robot has no model (yet), or what has become of a map or cloud. It keeps what it has.
  void setMissing(const std::string& name, const std::string& sentence);
  /// All rules of the allowed-pair matrix, from the next tick on; they end by themselves.
  void setRules(std::vector<PairRule> rules);
  /// Obstacles as configured, counters at 0, a new epoch. Rules stay.
  void reset();

  std::shared_ptr<const Tick> tick(const Moment& now);

 private:
  /// A body that follows a frame, and its pose in it.
  struct Member {
    BodyId body;
    bool at_frame;  // the pose is the identity
    Pose frame_from_body;
  };
  /// Bodies that one tf frame places.
  struct Mover {
    std::string frame;
    std::string robot;                // empty: an obstacle
    std::size_t first = 0, last = 0;  // its members in members_, last excluded
    KeptPose pose;
    bool settled = false;   // nothing can move it but a new transform on /tf_static, and nothing is wrong
    bool conflict = false;  // a frame on its way comes on /tf and on /tf_static
    std::optional<Refusal> trouble;
  };

  /// A cloud, and how often messages come.
  struct Cloud {
    BodyId body;
    LoadedCloud newest;
    double period = 0.0;  // [s] between stamps, smoothed
    std::string refused;  // why a message since then could not be read
  };

  /// Movers and bodies that take the place of those there are. It is built beside them, then put in their place as a
  /// whole: see exchange().
  struct Change {
    std::vector<Mover> movers;
    std::vector<Member> members;  // those of `in` come last, without their handles
    std::vector<BodyId> out;      // bodies that leave the scene
    std::vector<Body> in;         // bodies that enter it
    void add(const std::string& frame, const std::string& robot, const Body& body, const Pose& frame_from_body);
    void join(const Body& body, const Pose& frame_from_body);
  };
  /// The change that removes the movers of the chosen robots (obstacles: "", maps: the body's name).
  Change changeWithout(const std::function<bool(const std::string& robot)>& chosen) const;
  void exchange(Change change);
  static Member memberOf(BodyId body, const Pose& frame_from_body);

  void addObstacles();
  void addObstacle(const ObstacleParams& configured);
  void beginEpoch();
  using RobotsByName = std::map<std::string, const LoadedRobot*>;
  std::shared_ptr<const ModelReport> reportWith(const LoadedRobot& loaded) const;
  void warnOfIdlePatterns(const RobotsByName& robots, ModelReport& report) const;
  void applyRules(const Moment& now);
  bool findWorldFrame();
  void handleClock(const Moment& now);
  void restamp(const Moment& now);
  void tellStamp(const Mover& mover);
  void planWays();
  void place(Mover& mover, const FramePoses::Found& found, bool moves);
  Freshness judge(const Mover& mover, const ChainState& chain) const;
  void update(std::size_t index, Tick& tick);
  bool isConnected(const std::string& frame) const;
  std::vector<SourceGap> gaps(const Moment& now) const;
  SourceGap gapOf(const std::string& thing, const std::string& sentence) const;
  SourceGap gapOf(const BodyTrouble& trouble, const Cloud& cloud) const;
  Freshness judgeCloud(const Cloud& cloud, const Moment& now, double& age) const;
  void updateClouds(Time time, const Moment& now, Tick& tick, std::vector<SourceGap>& gaps);
  void unsettle();
  void setState(const Mover& mover, Freshness state, double age);
  void describeTrouble(const Mover& mover, Tick& tick) const;

  const Params& params_;
  Ledger& ledger_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  TfIntake intake_;
  FramePoses poses_;  // of the frames of movers_, in their order
  ClockWatch watch_;
  Scene scene_;
  std::vector<Mover> movers_;
  std::vector<Member> members_;  // of all movers, in their order: a tick runs through them
  std::vector<Pose> placed_;     // scratch of place()
  bool movers_changed_ = true;
  std::uint64_t settled_revision_ = 0;     // of /tf_static
  std::map<Time, std::uint32_t> cohorts_;  // of this tick: bodies of one stamp are equally old
  std::map<std::string, LoadedRobot> robots_;
  std::map<std::string, Body> maps_;  // by name of the body
  MapNews map_news_;
  std::map<std::string, Cloud> clouds_;         // by name of the body
  std::map<std::string, std::string> missing_;  // sentence by robot, map/name, cloud/name
  std::shared_ptr<const ModelReport> report_ = std::make_shared<ModelReport>();
  RuleBook rules_;
  bool rules_changed_ = false;  // the scene does not have them yet
  std::string world_frame_;
  std::size_t obstacles_done_ = 0;                           // of the configured ones: added or refused
  ClockWatch::Event clock_event_ = ClockWatch::Event::none;  // not handled yet
  std::uint64_t epoch_;
};

}  // namespace hgrid
