// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The only file of the benchmark that uses class HGrid.
#include "bench/peers/hgrid_peer.h"

#include <limits>
#include <numeric>
#include <optional>

#include "bench/queries/query_peer.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {
namespace bench {
namespace {

/// If all boxes moved, passes them to HGrid::update(). Otherwise passes the boxes that moved to HGrid::move().
class HGridPeer final : public Peer {
 public:
  HGridPeer(int threads, Isa isa) : threads_(threads), isa_(isa) {}

  void load(const std::vector<Aabb>& boxes) override {
    grid_.emplace(GridScale::fitting(boxes));
    grid_->setThreads(threads_);
    grid_->setIsa(isa_);
    ids_.resize(boxes.size());
    std::iota(ids_.begin(), ids_.end(), 0);
    grid_->update(ids_, boxes);
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    if (frame.moved.size() == frame.boxes.size()) {
      grid_->update(ids_, frame.boxes);
    } else {
      grid_->move(frame.moved, frame.moved_boxes);
    }
    grid_->overlappingPairs(pairs);
  }

  std::size_t bytes() const override { return grid_->bytes(); }

 private:
  int threads_;
  Isa isa_;
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

  bool answers(QueryKind) const override { return true; }

  void sphere(const Sphere& sphere, std::vector<ProxyId>& found) override { grid_->overlapping(sphere, found); }
  void box(const Aabb& box, std::vector<ProxyId>& found) override { grid_->overlapping(box, found); }
  void segment(const Segment& segment, std::vector<ProxyId>& found) override {
    grid_->along(segment, met_);
    found.clear();
    for (const SegmentHit& hit : met_) found.push_back(hit.id);
  }
  void nearest(const Eigen::Vector3d& point, std::size_t k, std::vector<ProxyId>& found) override {
    grid_->nearest(point, k, std::numeric_limits<double>::infinity(), near_);
    found.clear();
    for (const NearHit& hit : near_) found.push_back(hit.id);
  }

 private:
  std::optional<HGrid> grid_;
  std::vector<SegmentHit> met_;
  std::vector<NearHit> near_;
};

constexpr Isa kIsas[] = {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon};

}  // namespace

std::vector<std::string> hgridInstructions() {
  std::vector<std::string> names;
  for (const Isa isa : kIsas) {
    if (isSupported(isa) && isa <= bestIsa()) names.push_back(name(isa));
  }
  return names;
}

std::unique_ptr<Peer> makeHGrid(int threads, const std::string& instructions) {
  Isa chosen = bestIsa();
  for (const Isa isa : kIsas) {
    if (name(isa) == instructions) chosen = isa;
  }
  return std::make_unique<HGridPeer>(threads, chosen);
}

std::unique_ptr<QueryPeer> makeHGridQueries() { return std::make_unique<HGridQueries>(); }

}  // namespace bench
}  // namespace hgrid
