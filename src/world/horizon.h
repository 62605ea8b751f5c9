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
  /// Sets the poses and boxes of a new tick and compares them with the last accepted tick. If a body had no pose in the
  /// last accepted tick, or if the structure is new, the swept box is the present box.
  void step(const std::shared_ptr<const Structure>& structure, const std::vector<BodyPose>& poses,
            const std::vector<Aabb>& boxes);
  /// Accepts the tick of the last step(): the next step() compares with it. Allocates no memory.
  void accept();
  /// Returns how far [m] a body can be from its pose at the end of the horizon.
  double reachOf(std::uint32_t body) const { return on() ? reach_[body] : 0.0; }
  /// Returns the box around a proxy's boxes of this tick and of the last accepted tick.
  const Aabb& swept(ProxyId proxy) const { return swept_[proxy]; }
  /// Returns the box of a proxy in the last accepted tick. If the proxy had no box in that tick, returns its present
  /// box.
  const Aabb& before(ProxyId proxy) const {
    return was_placed_[now_.structure->body_of_proxy[proxy]] ? last_.boxes[proxy] : now_.boxes[proxy];
  }
  /// Returns whether two proxies may have come within the margin since the last tick, or may meet before the end of the
  /// horizon.
  bool canMeet(const Structure& structure, ProxyId first, ProxyId second, double gap, double margin) const;
  /// Returns whether a body moved farther since the last tick than its max_speed allows.
  bool teleported(std::uint32_t body) const { return on() && teleported_[body]; }

 private:
  double reachOf(const Body& body, const BodyPose& pose) const;

  double seconds_, cap_;
  /// The data of one tick that the next tick needs.
  struct Kept {
    std::shared_ptr<const Structure> structure;
    std::vector<Aabb> boxes;   // for each proxy: its box
    std::vector<Time> stamps;  // for each body: stamp of its pose; negative: the body had no pose
  };
  Kept last_, now_;               // last_: the last accepted tick; now_: the tick of the last step()
  std::vector<Aabb> swept_;       // for each proxy: box around its box in the last tick and its present box
  std::vector<bool> was_placed_;  // for each body: whether it had a pose in the last tick, in the same structure
  std::vector<bool> teleported_;  // for each body: see teleported()
  std::vector<double> reach_;     // [m] for each body: see reachOf()
};

}  // namespace hgrid
