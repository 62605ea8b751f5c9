// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/brute_force.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "test/support/oracle.h"

namespace hgrid {
namespace test {
namespace {

void require(bool holds, const char* rule) {
  if (!holds) throw std::invalid_argument(std::string("BruteForce: ") + rule);
}

void requireAscending(const std::vector<ProxyId>& ids) {
  for (std::size_t i = 1; i < ids.size(); ++i) require(ids[i - 1] < ids[i], "ids must ascend");
}

void requireBulk(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  require(ids.size() == boxes.size(), "there must be as many ids as boxes");
  requireAscending(ids);
  for (const Aabb& box : boxes) require(isValid(box), "a box must be valid");
}

}  // namespace

void BruteForce::insert(ProxyId id, const Aabb& box) {
  require(isValid(box), "a box must be valid");
  require(boxes_.emplace(id, box).second, "an inserted id must be new");
}

void BruteForce::update(ProxyId id, const Aabb& box) {
  require(isValid(box), "a box must be valid");
  require(boxes_.count(id) != 0, "an updated box must be stored");
  boxes_[id] = box;
}

void BruteForce::remove(ProxyId id) { require(boxes_.erase(id) != 0, "a removed box must be stored"); }

void BruteForce::update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  requireBulk(ids, boxes);
  boxes_.clear();
  for (std::size_t i = 0; i < ids.size(); ++i) boxes_[ids[i]] = boxes[i];
}

void BruteForce::move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  requireBulk(ids, boxes);
  for (const ProxyId id : ids) require(boxes_.count(id) != 0, "a moved box must be stored");
  for (std::size_t i = 0; i < ids.size(); ++i) boxes_[ids[i]] = boxes[i];
}

void BruteForce::setFixed(const std::vector<ProxyId>& ids) {
  requireAscending(ids);
  fixed_ = std::set<ProxyId>(ids.begin(), ids.end());
}

bool BruteForce::collect(const PairBound& bound, std::vector<ProxyPair>& pairs) const {
  pairs.clear();
  std::size_t overlaps = 0;
  for (const auto& one : boxes_) {
    if (fixed_.count(one.first) != 0) continue;
    for (const auto& other : boxes_) {
      const bool comes_later = other.first > one.first || fixed_.count(other.first) != 0;
      if (!comes_later || !oracleOverlap(one.second, other.second)) continue;
      if (++overlaps > bound.overlaps) return false;
      const ProxyPair pair{std::min(one.first, other.first), std::max(one.first, other.first)};
      if (!isKept(pair)) continue;
      if (pairs.size() == bound.pairs) return false;
      pairs.push_back(pair);
    }
  }
  return true;
}

void BruteForce::overlapping(const Aabb& box, std::vector<ProxyId>& found) const {
  found.clear();
  for (const auto& stored : boxes_) {
    if (oracleOverlap(box, stored.second)) found.push_back(stored.first);
  }
}

void BruteForce::overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const {
  found.clear();
  for (const auto& stored : boxes_) {
    if (touches(sphere, stored.second)) found.push_back(stored.first);
  }
}

void BruteForce::along(const Segment& segment, std::vector<SegmentHit>& found) const {
  found.clear();
  for (const auto& stored : boxes_) {
    if (const auto meeting = meet(segment, stored.second)) found.push_back({stored.first, meeting->along});
  }
  std::sort(found.begin(), found.end(),
            [](const SegmentHit& a, const SegmentHit& b) { return std::tie(a.along, a.id) < std::tie(b.along, b.id); });
}

void BruteForce::nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
                         std::vector<NearHit>& found) const {
  found.clear();
  for (const auto& stored : boxes_) {
    const double away = distance(stored.second, point);
    if (away <= limit) found.push_back({stored.first, away});
  }
  std::sort(found.begin(), found.end(),
            [](const NearHit& a, const NearHit& b) { return std::tie(a.distance, a.id) < std::tie(b.distance, b.id); });
  found.resize(std::min(count, found.size()));
}

void BruteForce::checkInvariants() const {
  for (const auto& stored : boxes_) {
    if (!isValid(stored.second)) throw std::logic_error("BruteForce: a stored box is not valid");
  }
}

}  // namespace test
}  // namespace hgrid
