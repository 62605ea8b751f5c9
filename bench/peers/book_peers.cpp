// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/book_peers.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/partitions/partitions.h"

namespace hgrid {
namespace bench {
namespace {

/// Makes a broad phase and stores the boxes in it. The first query makes it build its structure.
std::unique_ptr<BroadPhase> loaded(BroadPhaseType type, const std::vector<Aabb>& boxes) {
  std::vector<ProxyId> ids(boxes.size());
  std::iota(ids.begin(), ids.end(), 0);
  BroadPhaseOptions options;
  options.type = type;
  options.finest_edge = GridScale::fitting(boxes).finest_edge;
  std::unique_ptr<BroadPhase> made = makeBroadPhase(options);
  made->update(ids, boxes);
  std::vector<ProxyId> found;
  if (!boxes.empty()) made->overlapping(boxes.front(), found);
  return made;
}

class PartitionPeer final : public Peer {
 public:
  explicit PartitionPeer(BroadPhaseType type) : type_(type) {}

  void load(const std::vector<Aabb>& boxes) override { partition_ = loaded(type_, boxes); }
  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    partition_->move(frame.moved, frame.moved_boxes);
    partition_->overlappingPairs(pairs);
  }
  std::size_t bytes() const override { return storedBytes(*partition_); }

 private:
  BroadPhaseType type_;
  std::unique_ptr<BroadPhase> partition_;
};

class PartitionQueries final : public QueryPeer {
 public:
  explicit PartitionQueries(BroadPhaseType type) : type_(type) {}

  void load(const std::vector<Aabb>& boxes) override { partition_ = loaded(type_, boxes); }
  bool answers(QueryKind) const override { return true; }
  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override { partition_->overlapping(sphere, found); }
  void box(const Aabb& box, std::vector<ProxyId>& found) override { partition_->overlapping(box, found); }
  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    partition_->along(segment, met_);
    found.clear();
    for (const SegmentHit& hit : met_) found.push_back(hit.id);
  }
  void nearest(const Eigen::Vector3d& point, std::size_t k, std::vector<ProxyId>& found) override {
    partition_->nearest(point, k, std::numeric_limits<double>::infinity(), near_);
    found.clear();
    for (const NearHit& hit : near_) found.push_back(hit.id);
  }

 private:
  BroadPhaseType type_;
  std::unique_ptr<BroadPhase> partition_;
  std::vector<SegmentHit> met_;
  std::vector<NearHit> near_;
};

}  // namespace

std::vector<PeerKind> bookPeers() {
  constexpr std::size_t kMost = 100000, kQuickMost = 10000;
  std::vector<PeerKind> kinds;
  for (const BroadPhaseType type : broadPhaseTypes()) {
    if (type == BroadPhaseType::hgrid) continue;
    kinds.push_back({name(type), "default", kMost, kQuickMost, [=] { return std::make_unique<PartitionPeer>(type); }});
  }
  return kinds;
}

std::vector<QueryPeerKind> bookQueryPeers() {
  std::vector<QueryPeerKind> kinds;
  for (const BroadPhaseType type : broadPhaseTypes())
    kinds.push_back({name(type), [=] { return std::make_unique<PartitionQueries>(type); }});
  return kinds;
}

Loading loadingOf(BroadPhaseType type, const std::vector<Aabb>& boxes) {
  constexpr std::size_t kRuns = 5;
  std::vector<double> times;
  Loading loading;
  while (times.size() < kRuns) {
    const auto begin = std::chrono::steady_clock::now();
    const std::unique_ptr<BroadPhase> made = loaded(type, boxes);
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
    loading.bytes = double(storedBytes(*made)) / double(std::max<std::size_t>(boxes.size(), 1));
  }
  std::sort(times.begin(), times.end());
  loading.ms = times[kRuns / 2];
  return loading;
}

}  // namespace bench
}  // namespace hgrid
