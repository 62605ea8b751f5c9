// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <numeric>

#include "bench/singles/single_peer.h"
#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/partitions/partitions.h"

namespace hgrid {
namespace bench {
namespace {

/// A broad phase of this library.
class LibrarySingles final : public SinglePeer {
 public:
  explicit LibrarySingles(BroadPhaseType type) : type_(type) {}

  void load(const std::vector<Aabb>& boxes) override {
    std::vector<ProxyId> ids(boxes.size());
    std::iota(ids.begin(), ids.end(), 0);
    BroadPhaseOptions options;
    options.type = type_;
    options.finest_edge = GridScale::fitting(boxes).finest_edge;
    broad_phase_ = makeBroadPhase(options);
    broad_phase_->update(ids, boxes);
  }
  void update(ProxyId id, const Aabb& box) override { broad_phase_->update(id, box); }
  void replace(ProxyId id, const Aabb& box) override {
    broad_phase_->remove(id);
    broad_phase_->insert(id, box);
  }
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) override { broad_phase_->overlapping(box, found); }

 private:
  BroadPhaseType type_;
  std::unique_ptr<BroadPhase> broad_phase_;
};

}  // namespace

std::vector<SinglePeerKind> singlePeers() {
  std::vector<SinglePeerKind> kinds;
  for (const BroadPhaseType type : {BroadPhaseType::hgrid, BroadPhaseType::hashed_hgrid})
    kinds.push_back({name(type), [=] { return std::make_unique<LibrarySingles>(type); }});
#ifdef HGRID_BENCH_BULLET
  kinds.push_back({"Bullet dbvt", makeBulletSingles});
#endif
#ifdef HGRID_BENCH_BOX3D
  kinds.push_back({"Box3D", makeBox3dSingles});
#endif
#ifdef HGRID_BENCH_JOLT
  kinds.push_back({"Jolt", makeJoltSingles});
#endif
  return kinds;
}

}  // namespace bench
}  // namespace hgrid
