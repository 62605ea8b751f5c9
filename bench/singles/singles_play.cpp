// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/singles/singles_play.h"

#include <utility>

#include "bench/measure/turns.h"

namespace hgrid {
namespace bench {
namespace {

void addHits(std::size_t step, const std::vector<ProxyId>& found, Sample& result, Checksum& sum) {
  result.count += found.size();
  for (const ProxyId id : found) sum.add(std::uint64_t{step} << 32 | id);
}

}  // namespace

const char* name(StepKind kind) {
  return kind == StepKind::update ? "update" : kind == StepKind::update_query ? "update, query" : "replace, query";
}

SingleSteps::SingleSteps(std::vector<Aabb> at_start, std::size_t count) : start(std::move(at_start)) {
  std::vector<Aabb> now = start;
  Random random(7);
  for (std::size_t i = 0; i < count; ++i) {
    const auto id = static_cast<ProxyId>(random.below(now.size()));
    const double side = (now[id].max - now[id].min).cast<double>().maxCoeff();
    Eigen::Vector3f by;
    for (int axis = 0; axis < 3; ++axis) by[axis] = static_cast<float>(random.uniform(-0.1, 0.1) * side);
    now[id].min += by;
    now[id].max += by;
    ids.push_back(id);
    boxes.push_back(now[id]);
  }
}

Sample expectedOf(const SingleSteps& steps) {
  std::vector<Aabb> now = steps.start;
  Sample result;
  Checksum sum;
  for (std::size_t i = 0; i < SinglesPlay::kJudged; ++i) {
    now[steps.ids[i]] = steps.boxes[i];
    std::vector<ProxyId> found;
    for (ProxyId id = 0; id < now.size(); ++id) {
      if (overlap(now[id], steps.boxes[i])) found.push_back(id);
    }
    addHits(i, found, result, sum);
  }
  result.checksum = sum.value();
  return result;
}

SinglesPlay::SinglesPlay(std::unique_ptr<SinglePeer> peer, StepKind kind, const SingleSteps& steps)
    : peer_(std::move(peer)), kind_(kind), steps_(&steps) {
  peer_->load(steps.start);
  Checksum sum;
  for (std::size_t i = 0; i < kJudged; ++i) {
    step(i, true);
    addHits(i, found_, result_, sum);
  }
  result_.checksum = sum.value();
}

void SinglesPlay::step(std::size_t number, bool asks) {
  const ProxyId id = steps_->ids[number];
  const Aabb& box = steps_->boxes[number];
  if (kind_ == StepKind::replace_query) {
    peer_->replace(id, box);
  } else {
    peer_->update(id, box);
  }
  if (asks) peer_->overlapping(box, found_);
}

double SinglesPlay::timedChunk() {
  if (next_ + kChunk > steps_->ids.size()) {  // the boxes return to where they were after the judged steps
    peer_->load(steps_->start);
    for (std::size_t i = 0; i < kJudged; ++i) step(i, true);
    next_ = kJudged;
  }
  const Clock::time_point begin = Clock::now();
  for (std::size_t i = 0; i < kChunk; ++i) step(next_ + i, kind_ != StepKind::update || i + 1 == kChunk);
  next_ += kChunk;
  return msSince(begin);
}

std::vector<Sample> SinglesPlay::operator()(double budget_ms) {
  return samplesFor(budget_ms, result_, [this] { return timedChunk(); });
}

}  // namespace bench
}  // namespace hgrid
