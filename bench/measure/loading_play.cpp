// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/measure/loading_play.h"

#include "bench/measure/turns.h"

namespace hgrid {
namespace bench {

std::vector<Sample> LoadingPlay::operator()(double budget_ms) {
  const Clock::time_point begin = Clock::now();
  std::vector<Sample> samples;
  while (samples.empty() || msSince(begin) < budget_ms) {
    world_->reset();
    std::vector<ProxyPair> pairs;
    Clock::time_point start = Clock::now();
    const std::unique_ptr<Peer> peer = make_();
    peer->load(world_->boxes());
    Sample sample;
    sample.ms = msSince(start);
    world_->step();
    start = Clock::now();
    peer->frame(world_->frame(), pairs);
    sample.ms += msSince(start);
    sample.count = pairs.size();
    sample.checksum = checksumOf(pairs);
    sample.number = world_->frameNumber();
    sample.timed = 1;
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace bench
}  // namespace hgrid
