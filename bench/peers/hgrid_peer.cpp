// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// All that the benchmark knows of HGrid.
#include "bench/peers/hgrid_peer.h"

#include <numeric>
#include <optional>

#include "bench/queries/query_peer.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {
namespace bench {
namespace {

class HGridPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    grid_.emplace(GridScale::fitting(boxes));
    ids_.resize(boxes.size());
    std::iota(ids_.begin(), ids_.end(), 0);
    grid_->update(ids_, boxes);
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    grid_->update(ids_, frame.boxes);
    grid_->overlappingPairs(pairs);
  }

 private:
  std::optional<HGrid> grid_;
  std::vector<ProxyId> ids_;
};

class HGridQueries final : public QueryPeer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    std::vector<ProxyId> ids(boxes.size());
    std::iota(ids.begin(), ids.end(), 0);
    grid_.emplace(GridScale::fitting(boxes));
    grid_->update(ids, boxes);
  }

  bool answers(QueryKind kind, bool batched) const override {
    return !batched && kind != QueryKind::nearest && kind != QueryKind::nearest8;
  }

  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override { grid_->overlapping(sphere, found); }
  void box(const Aabb& box, std::vector<ProxyId>& found) override { grid_->overlapping(box, found); }
  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    grid_->along(segment, met_);
    found.clear();
    for (const SegmentHit& hit : met_) found.push_back(hit.id);
  }

 private:
  std::optional<HGrid> grid_;
  std::vector<SegmentHit> met_;
};

}  // namespace

std::vector<std::string> hgridInstructions() { return {"sse2"}; }

std::unique_ptr<Peer> makeHGrid(int /*threads*/, const std::string& /*instructions*/) {
  return std::make_unique<HGridPeer>();
}

std::unique_ptr<QueryPeer> makeHGridQueries() { return std::make_unique<HGridQueries>(); }

}  // namespace bench
}  // namespace hgrid
