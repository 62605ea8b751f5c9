// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Looks at the time between two ticks and a short time ahead. It computes the boxes that shapes swept since the last
/// tick. It also computes how far each body can move before the end of the horizon, according to its max_speed. It does
/// nothing if the horizon is 0.
class Horizon {
 public:
  /// @param seconds  [s] length of the horizon, >= 0
  /// @param cap      [m] distance that a body without max_speed is assumed to move; also the largest distance that a
  ///                 body with max_speed is assumed to have moved since its pose
  Horizon(double seconds, double cap) : seconds_(seconds), cap_(cap) {}

  bool on() const { return seconds_ > 0.0; }
  /// Sets the values of the constructor. If the horizon was off, the next tick has no last tick to compare with.
  void set(double seconds, double cap) {
    if (!on()) last_ = {};
    seconds_ = seconds;
    cap_ = cap;
  }
  /// Sets the poses and boxes of a new tick and compares them with the last accepted tick. If a body had no pose in the
  /// last accepted tick, or if it was added since, the swept box is the present box.
  /// @param stamp  time of the new tick; a pose with an older stamp lags behind it
  void step(const std::shared_ptr<const Structure>& structure, const std::vector<BodyPose>& poses,
            const std::vector<Aabb>& boxes, Time stamp);
  /// Accepts the tick of the last step(): the next step() compares with it. Allocates no memory.
  void accept();
  /// Returns how far [m] a body can be from its pose at the end of the horizon.
  double reachOf(std::uint32_t body) const { return on() ? reach_[body] : 0.0; }
  /// Returns how far [m] a body can have moved from the stamp of its pose to the time of the tick.
  double driftOf(std::uint32_t body) const { return on() ? drift_[body] : 0.0; }
  /// Returns an upper bound [m] of the length of the way that any point of a body went since the last accepted tick, at
  /// most the cap. 0 if the body had no pose in that tick.
  double wayOf(std::uint32_t body) const { return on() ? way_[body] : 0.0; }
  /// Returns a box that contains a proxy at each time since the last accepted tick, if the body kept its max_speed. A
  /// body that turns may leave the box around its boxes of both ticks.
  const Aabb& swept(ProxyId proxy) const { return swept_[proxy]; }
  /// Returns the box of a proxy in the last accepted tick. If the proxy had no box in that tick, returns its present
  /// box.
  const Aabb& before(ProxyId proxy) const { return before_[proxy]; }
  /// Returns whether two proxies may have come within the margin since the last tick, or may meet before the end of the
  /// horizon.
  bool canMeet(const Structure& structure, ProxyId first, ProxyId second, double gap, double margin) const;
  /// Returns whether a body moved farther since the last tick than its max_speed allows.
  bool teleported(std::uint32_t body) const { return on() && teleported_[body]; }

 private:
  double reachOf(const Body& body, const BodyPose& pose, double drift) const;
  double driftOf(const Body& body, const BodyPose& pose, Time stamp) const;
  void matchBodies(const Structure& structure);
  void sweep(const Structure& structure, std::uint32_t body, const BodyPose& pose);

  double seconds_, cap_;
  /// The data of one tick that the next tick needs.
  struct Kept {
    std::shared_ptr<const Structure> structure;
    std::vector<Aabb> boxes;   // for each proxy: its box
    std::vector<Time> stamps;  // for each body: stamp of its pose; negative: the body had no pose
  };
  Kept last_, now_;                        // last_: the last accepted tick; now_: the tick of the last step()
  std::vector<Aabb> before_;               // for each proxy: see before()
  std::vector<Aabb> swept_;                // for each proxy: see swept()
  std::vector<std::uint32_t> last_body_;   // for each body: its index in last_.structure, or Structure::kNone
  std::vector<std::uint32_t> last_slots_;  // buffer of matchBodies(): for each slot: index in last_.structure
  std::vector<bool> teleported_;           // for each body: see teleported()
  std::vector<double> reach_;              // [m] for each body: see reachOf()
  std::vector<double> drift_;              // [m] for each body: see driftOf()
  std::vector<double> way_;                // [m] for each body: see wayOf()
};

}  // namespace hgrid
