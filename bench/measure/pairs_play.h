// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>

#include "bench/measure/contestant.h"
#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

/// How a peer plays frames.
///
/// A fresh peer (age 0) plays laps: loaded with the boxes of frame 0 it plays frames 1 .. kLap, the first kWarmUp of
/// them untimed, and a new peer starts over, until the budget is used. So a tree that ages is seen young, and all peers
/// see the same frames. An aged one is loaded once, plays `age` frames untimed, and then goes on by a lap in each
/// block.
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

  World* world_;  // after the fork a copy of our own
  std::function<std::unique_ptr<Peer>()> make_;
  std::uint64_t age_;
  std::unique_ptr<Peer> peer_;
  std::vector<ProxyPair> pairs_;
  double held_before_ = 0.0;  // by this process without the peer and without the pairs
};

}  // namespace bench
}  // namespace hgrid
