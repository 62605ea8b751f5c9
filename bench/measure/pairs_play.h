// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>

#include "bench/measure/contestant.h"
#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

/// Runs a peer and measures the time of each frame. A frame of the benchmark is one time step: boxes move, then the
/// peer finds all overlapping pairs.
///
/// With age 0, each lap creates a new peer, which loads the boxes of frame 0 and runs the frames 1 .. kLap. The first
/// kWarmUp frames of a lap are not timed. Laps repeat until the time budget is used. Trees that get slower with age are
/// thus measured when they are new, and all peers run the same frames.
///
/// With another age, the peer is loaded once and runs `age` frames without timing. Then each block is a lap of timed
/// frames.
class PairsPlay {
 public:
  static constexpr std::uint64_t kWarmUp = 2, kLap = 12;

  PairsPlay(World& world, std::function<std::unique_ptr<Peer>()> make, std::uint64_t age)
      : world_(&world), make_(std::move(make)), age_(age) {}

  std::vector<Sample> operator()(double budget_ms);

 private:
  void start();
  Sample frame();
  double bytes() const;

  World* world_;  // a private copy, because this class runs in a child process
  std::function<std::unique_ptr<Peer>()> make_;
  std::uint64_t age_;
  std::unique_ptr<Peer> peer_;
  std::vector<ProxyPair> pairs_;
  double held_before_ = 0.0;  // [byte] memory of the process without the peer and `pairs_`
};

}  // namespace bench
}  // namespace hgrid
