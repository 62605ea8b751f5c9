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
  /// @param prepared  whether load() also calls prepareQueries()
  explicit HGridQueries(bool prepared) : prepared_(prepared) {}

  void load(const std::vector<Aabb>& boxes) override {
    std::vector<ProxyId> ids(boxes.size());
    std::iota(ids.begin(), ids.end(), 0);
    grid_.emplace(GridScale::fitting(boxes));
    grid_->update(ids, boxes);
    if (prepared_) grid_->prepareQueries();
  }

  bool answers(QueryKind kind, bool batched) const override {
    return !batched || (kind != QueryKind::nearest && kind != QueryKind::nearest8);
  }

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

  void batch(QueryKind kind, const QuerySet& queries) override {
    segments_asked_ = kind == QueryKind::segment;
    if (kind == QueryKind::sphere) grid_->overlapping(queries.spheres, ids_);
    if (kind == QueryKind::box) grid_->overlapping(queries.boxes, ids_);
    if (kind == QueryKind::segment) grid_->along(queries.segments, segments_);
  }
  void batchHits(std::size_t query, std::vector<ProxyId>& found) const override {
    found.clear();
    const std::size_t begin = segments_asked_ ? segments_.begin[query] : ids_.begin[query];
    const std::size_t count = segments_asked_ ? segments_.count[query] : ids_.count[query];
    for (std::size_t i = begin; i < begin + count; ++i)
      found.push_back(segments_asked_ ? segments_.found[i].id : ids_.found[i]);
  }

 private:
  bool prepared_;
  std::optional<HGrid> grid_;
  std::vector<SegmentHit> met_;
  std::vector<NearHit> near_;
  IdBatch ids_;
  SegmentBatch segments_;
  bool segments_asked_ = false;
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

std::unique_ptr<QueryPeer> makeHGridQueries() { return std::make_unique<HGridQueries>(true); }

std::unique_ptr<QueryPeer> makeUnpreparedHGridQueries() { return std::make_unique<HGridQueries>(false); }

}  // namespace bench
}  // namespace hgrid
