// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/meshes/mesh_peer.h"
#include "narrow/mesh_tree.h"

namespace hgrid {
namespace bench {
namespace {

class HgridMeshes final : public MeshPeer {
 public:
  HgridMeshes(const TriangleMesh& first, const TriangleMesh& second) : first_(first), second_(second) {}

  double distance(const Pose& first_from_second, double up_to) const override {
    const CoreGap gap = first_.gapTo(second_, first_from_second, {0.0, up_to});
    return gap.lower <= 0.0 ? 0.0 : gap.upper;
  }

 private:
  MeshTree first_, second_;
};

}  // namespace

std::unique_ptr<MeshPeer> makeHgridMeshes(const TriangleMesh& first, const TriangleMesh& second) {
  return std::make_unique<HgridMeshes>(first, second);
}

#ifndef HGRID_BENCH_FCL
std::unique_ptr<MeshPeer> makeFclMeshes(const TriangleMesh&, const TriangleMesh&) { return nullptr; }
#endif

}  // namespace bench
}  // namespace hgrid
