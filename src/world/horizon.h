// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// What can happen between two ticks and soon after: the boxes that shapes swept since the last one, and how far bodies
/// can go, by their max_speed, from the time of their poses until a horizon has passed. Off while the horizon is 0.
class Horizon {
 public:
  /// @param seconds  [s] >= 0
  /// @param cap      [m] how far a body without a bound of speed is taken to go, and the most that one with a bound is
  ///                 taken to have gone since its pose
  Horizon(double seconds, double cap) : seconds_(seconds), cap_(cap) {}

  bool on() const { return seconds_ > 0.0; }
  /// Takes the boxes and poses of a new tick. What had no pose before, or is in a new structure, swept nothing. The
  /// last tick stays the one that was accepted.
  void step(const std::shared_ptr<const Structure>& structure, const std::vector<BodyPose>& poses,
            const std::vector<Aabb>& boxes);
  /// Makes the tick of the last step() the last tick. Allocates nothing.
  void accept();
  /// [m] How far a body can be from its pose when the horizon has passed.
  double reachOf(std::uint32_t body) const { return on() ? reach_[body] : 0.0; }
  /// The box around a proxy's boxes of this tick and the last.
  const Aabb& swept(ProxyId proxy) const { return swept_[proxy]; }
  /// The proxy's box of the last tick; that of this one if it had none.
  const Aabb& before(ProxyId proxy) const {
    return was_placed_[now_.structure->body_of_proxy[proxy]] ? last_.boxes[proxy] : now_.boxes[proxy];
  }
  /// Whether two proxies may have come within the margin since the last tick, or may meet before the horizon has
  /// passed.
  bool canMeet(const Structure& structure, ProxyId first, ProxyId second, double gap, double margin) const;
  /// Whether a body moved farther since the last tick than its max_speed allows.
  bool teleported(std::uint32_t body) const { return on() && teleported_[body]; }

 private:
  double reachOf(const Body& body, const BodyPose& pose) const;

  double seconds_, cap_;
  /// What is kept of a tick.
  struct Kept {
    std::shared_ptr<const Structure> structure;
    std::vector<Aabb> boxes;   // by proxy
    std::vector<Time> stamps;  // by body; negative: it had no pose
  };
  Kept last_, now_;               // now_: of the last step(), not accepted yet
  std::vector<Aabb> swept_;       // by proxy
  std::vector<bool> was_placed_;  // by body: it had a pose in the last tick, and in this structure
  std::vector<bool> teleported_;  // by body
  std::vector<double> reach_;     // [m] by body
};

}  // namespace hgrid
