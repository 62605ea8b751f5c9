// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/broadphase/churn_world.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hgrid {
namespace test {
namespace {

/// A filter for pairs. It keeps two thirds of the pairs.
bool isReported(const void*, ProxyId first, ProxyId second) { return (first + second) % 3 != 0; }

}  // namespace

ChurnWorld::ChurnWorld(unsigned seed) : random_(seed) {}

void ChurnWorld::begin(std::size_t most_boxes) {
  most_ = most_boxes;
  if (boxes_.size() < most_) {
    boxes_.resize(most_);
    stored_.resize(most_);
    fixed_.resize(most_);
  }
  const std::vector<Isa> isas = supportedIsas();
  grid_.setIsa(isas[std::size_t(random_.below(int(isas.size())))]);
  if (random_.chance(0.2)) grid_.setThreads(random_.between(1, 3));
  filtered_ = random_.chance(0.3);
  grid_.setOverlapFilter(filtered_ ? OverlapFilter::of<isReported>(nullptr) : OverlapFilter{});
  lattice_ = random_.chance(0.15) && most_ < 5000;
  largest_ = random_.logUniform(0.1, 3);
  smallest_ = random_.chance(0.3) ? 1e-4 * largest_ : 0.2 * largest_;
  hall_ = largest_ * std::cbrt(double(most_)) * random_.uniform(0.7, 3);
  for (std::size_t id = 0; id < most_; ++id) boxes_[id] = someBox();
  fixOthers();
  updateAll(0.95, 0.5);
}

Aabb ChurnWorld::someBox() {
  if (lattice_) return latticeBox(random_, 0.5f);
  const double far = random_.chance(0.002) ? 1e4 : 1.0;  // a few boxes are far away from all others
  const double size = random_.chance(0.01) ? 10.0 * largest_ : random_.logUniform(smallest_, largest_);
  const Eigen::Vector3d center = far * randomVector(random_, -0.5 * hall_, 0.5 * hall_);
  return boxAround(center, size * randomVector(random_, random_.chance(0.05) ? 0.0 : 0.3, 1.0));
}

/// Returns a changed box. It has moved a little or by one unit in the last place, has a new size or place, or is the
/// same.
Aabb ChurnWorld::changed(const Aabb& box) {
  Aabb now = box;
  const int kind = random_.below(10);
  if (kind < 4) {
    const Eigen::Vector3f way = (0.1 * largest_ * randomVector(random_, -1, 1)).cast<float>();
    now = {box.min + way, box.max + way};
  } else if (kind < 5) {
    const int axis = random_.below(3);
    now.max[axis] = stepped(now.max[axis], random_.between(-1, 1));
  } else if (kind < 7) {
    now.max = now.min + float(random_.logUniform(0.2, 5)) * (now.max - now.min);
  } else if (kind < 9) {
    now = someBox();
  }
  now.max = now.max.cwiseMax(now.min);
  return (now.max - now.min).maxCoeff() < 20 * largest_ ? now : someBox();
}

std::vector<ProxyId> ChurnWorld::storedIds() const {
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < most_; ++id) {
    if (stored_[id]) ids.push_back(id);
  }
  return ids;
}

void ChurnWorld::act() {
  const int kind = random_.below(100);
  if (kind < 60) {
    for (int i = random_.chance(0.1) ? 150 : random_.between(1, 10); i > 0; --i) {
      actOnOne(ProxyId(random_.below(int(most_))));
    }
  } else if (kind < 85) {
    moveSome();
  } else if (kind < 96) {
    const bool same = random_.chance(0.5);
    updateAll(same ? 1.0 : 0.95, same ? 0.0 : 0.5);
  } else if (kind < 99) {
    fixOthers();
  } else {
    grid_.clear();
    std::fill(stored_.begin(), stored_.end(), false);
  }
  ++changes_;
}

void ChurnWorld::actOnOne(ProxyId id) {
  if (!stored_[id]) {
    boxes_[id] = someBox();
    grid_.insert(id, boxes_[id]);
    stored_[id] = true;
  } else if (random_.chance(0.3)) {
    grid_.remove(id);
    stored_[id] = false;
  } else {
    boxes_[id] = changed(boxes_[id]);
    grid_.update(id, boxes_[id]);
  }
}

void ChurnWorld::moveSome() {
  std::vector<ProxyId> ids;
  std::vector<Aabb> boxes;
  const double share = random_.logUniform(0.001, 1.0);
  for (const ProxyId id : storedIds()) {
    if (!random_.chance(share)) continue;
    boxes_[id] = changed(boxes_[id]);
    ids.push_back(id);
    boxes.push_back(boxes_[id]);
  }
  grid_.move(ids, boxes);
}

/// Updates all boxes with one call. Keeps or moves the fraction `kept` of the stored boxes, and adds the fraction
/// `coming` of the others.
void ChurnWorld::updateAll(double kept, double coming) {
  std::vector<ProxyId> ids;
  std::vector<Aabb> boxes;
  const double moving = random_.chance(0.3) ? 1.0 : random_.logUniform(0.001, 0.5);
  for (ProxyId id = 0; id < stored_.size(); ++id) {
    stored_[id] = id < most_ && random_.chance(stored_[id] ? kept : coming);
    if (!stored_[id]) continue;
    if (random_.chance(moving)) boxes_[id] = changed(boxes_[id]);
    ids.push_back(id);
    boxes.push_back(boxes_[id]);
  }
  grid_.update(ids, boxes);
}

void ChurnWorld::fixOthers() {
  std::vector<ProxyId> ids;
  const double share = random_.chance(0.5) ? 0.0 : random_.uniform(0, 0.9);
  for (ProxyId id = 0; id < fixed_.size(); ++id) {  // an id may be fixed even if no box with this id is stored
    fixed_[id] = random_.chance(share);
    if (fixed_[id]) ids.push_back(id);
  }
  grid_.setFixed(ids);
}

void ChurnWorld::check() {
  ASSERT_NO_THROW(grid_.checkInvariants());
  ASSERT_NO_FATAL_FAILURE(expectRightPairs());
  ASSERT_NO_FATAL_FAILURE(expectRightQueries());
}

void ChurnWorld::expectRightPairs() {
  Pairs expected = sweptOverlaps(boxes_, storedIds());
  const auto left_out = [this](const std::pair<std::uint32_t, std::uint32_t>& pair) {
    return (fixed_[pair.first] && fixed_[pair.second]) || (filtered_ && !isReported(nullptr, pair.first, pair.second));
  };
  expected.erase(std::remove_if(expected.begin(), expected.end(), left_out), expected.end());
  pairs_seen_ += expected.size();
  ASSERT_TRUE(pairsOf(grid_) == expected);
}

void ChurnWorld::expectRightQueries() {
  const std::vector<ProxyId> ids = storedIds();
  ASSERT_EQ(grid_.size(), ids.size());
  const Aabb box = someBox();
  const Sphere ball{box.min.cast<double>(), random_.chance(0.2) ? 0.0 : largest_ * random_.uniform(0, 2)};
  const Segment segment{ball.center, randomVector(random_, -0.5 * hall_, 0.5 * hall_), 0.2 * ball.radius};
  std::vector<ProxyId> in_box, in_ball;
  std::vector<SegmentHit> hits;
  std::vector<std::pair<double, ProxyId>> near;
  for (const ProxyId id : ids) {  // test/geometry tests the functions for single boxes
    if (oracleOverlap(box, boxes_[id])) in_box.push_back(id);
    if (touches(ball, boxes_[id])) in_ball.push_back(id);
    if (const auto along = FirstTouch(segment)(boxes_[id])) hits.push_back({id, *along});
    near.emplace_back(distance(boxes_[id], ball.center), id);
  }
  std::sort(hits.begin(), hits.end(), [](const SegmentHit& a, const SegmentHit& b) {
    return a.along != b.along ? a.along < b.along : a.id < b.id;
  });
  ASSERT_EQ(foundBy(grid_, box), in_box);
  ASSERT_EQ(foundBy(grid_, ball), in_ball);
  ASSERT_EQ(alongOf(grid_, segment), hits);
  std::sort(near.begin(), near.end());
  std::vector<NearHit> nearest;
  grid_.nearest(ball.center, 10, HUGE_VAL, nearest);
  ASSERT_EQ(nearest.size(), std::min<std::size_t>(10, near.size()));
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    ASSERT_EQ(std::make_pair(nearest[i].distance, nearest[i].id), near[i]);
  }
}

}  // namespace test
}  // namespace hgrid
