// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/maps/map_play.h"

#include <malloc.h>

#include <algorithm>

#include "bench/measure/held_bytes.h"
#include "bench/measure/turns.h"

namespace hgrid {
namespace bench {
namespace {

/// Returns the leaf that contains the cell. Returns the cell itself if no leaf contains it.
Voxel leafOf(const Voxel& cell, const std::vector<Voxel>& leaves) {
  const auto after = std::upper_bound(leaves.begin(), leaves.end(), mortonOf(cell),
                                      [](std::uint64_t code, const Voxel& leaf) { return code < mortonOf(leaf); });
  if (after == leaves.begin()) return cell;
  const Voxel& leaf = *(after - 1);
  return mortonOf(cell) >> 3 * leaf.level == mortonOf(leaf) >> 3 * leaf.level ? leaf : cell;
}

}  // namespace

std::vector<Sample> MakeMapPlay::operator()(double budget_ms) {
  const Clock::time_point all_begin = Clock::now();
  std::vector<Sample> samples;
  while (samples.empty() || msSince(all_begin) < budget_ms) {
    Sample sample;
    malloc_trim(0);
    const double held_before = heldBytes();
    const Clock::time_point begin = Clock::now();
    const std::unique_ptr<MapPeer> peer = make_(*map_);
    sample.ms = msSince(begin);
    sample.bytes = peer->bytes() > 0 ? static_cast<double>(peer->bytes()) : heldBytes() - held_before;
    sample.timed = 1;
    Checksum sum;
    for (const Voxel& leaf : peer->leaves()) {
      ++sample.count;
      sum.add(numberOf(leaf));
    }
    sample.checksum = sum.value();
    samples.push_back(sample);
  }
  return samples;
}

AskMapPlay::AskMapPlay(MapPeer& peer, MapQuestion kind, bool batched, const Map& map, const MapQuestions& questions,
                       const MapDoubts& doubts)
    : peer_(&peer), kind_(kind), batched_(batched), map_(&map), questions_(&questions), result_(compared(doubts)) {}

void AskMapPlay::answer(std::size_t question) {
  switch (kind_) {
    case MapQuestion::touches:
    case MapQuestion::small:
      return found_.resize(peer_->touches(questions_->spheresOf(kind_)[question]) ? 1 : 0);
    case MapQuestion::overlapping:
      return peer_->overlapping(questions_->spheres[question], found_);
    case MapQuestion::segment:
      found_.clear();
      if (const auto first = peer_->firstAlong(questions_->segments[question])) found_.push_back(*first);
  }
}

Sample AskMapPlay::compared(const MapDoubts& doubts) {
  Sample result;
  Checksum sum;
  for (std::size_t i = 0; i < questions_->size(); ++i) {
    if (doubts.doubts(i)) continue;
    answer(i);
    result.count += found_.size();
    for (Voxel& leaf : found_) {
      if (kind_ == MapQuestion::touches || kind_ == MapQuestion::small) leaf = Voxel{};
      if (kind_ == MapQuestion::segment) leaf = leafOf(leaf, map_->leaves);
      sum.add(mixed(i) + numberOf(leaf));
    }
  }
  result.checksum = sum.value();
  return result;
}

double AskMapPlay::timed() {
  const Clock::time_point begin = Clock::now();
  if (batched_) {
    for (const std::uint32_t i : questions_->inMortonOrder(map_->resolution)) answer(i);
    return msSince(begin);
  }
  for (std::size_t i = 0; i < kChunk; ++i) answer(next_ + i);
  next_ = (next_ + kChunk) % questions_->size();
  return msSince(begin);
}

std::vector<Sample> AskMapPlay::operator()(double budget_ms) {
  return samplesFor(budget_ms, result_, [this] { return timed(); });
}

}  // namespace bench
}  // namespace hgrid
