// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/health/ledger.h"
#include "node/params/params.h"
#include "node/tf/frame_poses.h"
#include "node/tick/tick.h"
#include "node/time/freshness.h"
#include "node/world/movers.h"

namespace hgrid {

/// In each tick, moves the bodies in the scene with their frames, and sets the state of each pose.
///
/// If a call throws because memory ran out, the next update() does the work that was not done.
class MoverPoses {
 public:
  MoverPoses(const Params& params, const TfIntake& intake, Scene& scene, Movers& movers, Ledger& ledger);

  /// Computes all poses of this tick. Appends to the troubles and to the missing frames of `tick`.
  /// @param clock_frozen  whether ROS time stands still
  /// @returns the time of the tick
  Time update(const Moment& now, bool clock_frozen, Tick& tick);
  /// Moves the stamps of the poses in use to the new ROS time. Call this after the clock was set.
  /// @param lost  whether the transforms were dropped, because they belong to an earlier run of a simulation
  void restamp(const Moment& now, bool lost);
  void beginEpoch() { frames_.beginEpoch(); }
  /// Returns the frames that hold back the time of the next tick.
  const std::vector<FrameStamp>& awaited() const { return frames_.awaited(); }
  /// Returns the reading of the age clock in the newest update().
  Time reading() const { return frames_.reading(); }

 private:
  void planChains(const std::string& world_frame);
  void updateOne(std::size_t index, bool clock_frozen, Tick& tick);
  void placeOnce(std::size_t index);
  void updateGivenUp(Mover& mover, Tick& tick);
  void place(Mover& mover, const FramePoses::Found& found, bool moves);
  void setState(const Mover& mover, Freshness state, double period);
  void setStamp(const Mover& mover);
  void unsettleAll();
  /// Whether nothing but a new plan can change the mover: it stands at the world frame, and nothing is wrong with it.
  bool isAtRest(std::size_t index) const {
    const Mover& mover = movers_[index];
    return mover.settled && !mover.given_up && frames_.isWorld(index);
  }
  Freshness judge(const Mover& mover, const ChainState& chain, bool clock_frozen) const;
  void appendTroubles(const Mover& mover, Tick& tick) const;

  const AgeLimits limits_;
  const TfIntake& intake_;
  Scene& scene_;
  Movers& movers_;
  Ledger& ledger_;
  FramePoses frames_;                        // poses of the frames of the movers, in the order of the movers
  std::uint64_t planned_revision_ = kNever;  // revision of the movers at the newest complete plan; kNever: none
  std::size_t planned_ = 0;                  // number of movers that active_ had room for at the last planChains()
  std::uint64_t settled_revision_ = 0;       // revision of /tf_static at the last unsettleAll()
  std::vector<std::size_t> active_;          // movers that are not at rest, ascending; all of them after unsettleAll()
  std::map<Time, std::uint32_t> cohorts_;    // this tick only: bodies with the same stamp share a cohort number
  std::vector<Pose> placed_;                 // buffer of place()

  static constexpr std::uint64_t kNever = ~std::uint64_t{0};
};

}  // namespace hgrid
