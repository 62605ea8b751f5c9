// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/measure/pairs_play.h"

#include <algorithm>

#include "bench/measure/held_bytes.h"
#include "bench/measure/turns.h"

namespace hgrid {
namespace bench {

void PairsPlay::start() {
  peer_.reset();
  world_->reset();
  held_before_ = heldBytes() - double(pairs_.capacity() * sizeof(ProxyPair));
  peer_ = make_();
  peer_->load(world_->boxes());
}

double PairsPlay::bytes() const {
  if (peer_->bytes() > 0) return double(peer_->bytes());
  return heldBytes() - double(pairs_.capacity() * sizeof(ProxyPair)) - held_before_;
}

Sample PairsPlay::frame() {
  world_->step();
  std::fill(pairs_.begin(), pairs_.end(), ProxyPair{});  // the peer must not reuse its pairs of the previous frame
  Sample sample;
  const Clock::time_point begin = Clock::now();
  peer_->frame(world_->frame(), pairs_);
  sample.ms = msSince(begin);
  sample.count = pairs_.size();
  sample.checksum = checksumOf(pairs_);
  sample.number = world_->frameNumber();
  return sample;
}

std::vector<Sample> PairsPlay::operator()(double budget_ms) {
  const Clock::time_point begin = Clock::now();
  std::vector<Sample> samples;
  while (samples.empty() || msSince(begin) < budget_ms) {
    const bool fresh = age_ == 0 || !peer_;
    if (fresh) {
      start();
      for (std::uint64_t i = 0; i < age_; ++i) peer_->remembers() ? static_cast<void>(frame()) : world_->step();
    }
    for (std::uint64_t i = 0; i < kLap && (i <= kWarmUp || msSince(begin) < budget_ms); ++i) {
      samples.push_back(frame());
      samples.back().timed = !fresh || age_ > 0 || i >= kWarmUp;
    }
    samples.back().bytes = bytes();
    if (age_ > 0) break;
  }
  return samples;
}

}  // namespace bench
}  // namespace hgrid
