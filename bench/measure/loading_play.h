// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "bench/measure/contestant.h"
#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

/// Measures how long a new peer takes to load all boxes and to find the pairs of the first frame. Both count, because
/// some peers only copy the boxes when they load them. The time in which the boxes move does not count; the
/// memory for the pairs does.
class LoadingPlay {
 public:
  LoadingPlay(World& world, std::function<std::unique_ptr<Peer>()> make) : world_(&world), make_(std::move(make)) {}

  std::vector<Sample> operator()(double budget_ms);

 private:
  World* world_;  // a private copy, because this class runs in a child process
  std::function<std::unique_ptr<Peer>()> make_;
};

}  // namespace bench
}  // namespace hgrid
