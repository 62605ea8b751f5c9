// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/distance.h>

#include <cmath>
#include <limits>

#include "bench/meshes/mesh_peer.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class FclMeshes final : public MeshPeer {
 public:
  FclMeshes(const TriangleMesh& first, const TriangleMesh& second) {
    fill(first, first_);
    fill(second, second_);
  }

  double distance(const Pose& first_from_second, double up_to) const override {
    fcl::DistanceRequestd request;
    request.enable_nearest_points = true;
    request.gjk_solver_type = fcl::GST_LIBCCD;
    fcl::DistanceResultd result;
    if (up_to < kInfinity) result.min_distance = std::nextafter(up_to, kInfinity);  // limits the search
    fcl::distance(&first_, fcl::Transform3d::Identity(), &second_, fcl::Transform3d(first_from_second.matrix()),
                  request, result);
    return result.o1 == nullptr ? kInfinity : std::max(0.0, result.min_distance);
  }

 private:
  static void fill(const TriangleMesh& mesh, fcl::BVHModel<fcl::OBBRSSd>& model) {
    model.beginModel();
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      // FCL divides by the area, so it must not be 0.
      if ((b - a).cross(c - a).squaredNorm() > 0.0) model.addTriangle(a, b, c);
    }
    model.endModel();
  }

  fcl::BVHModel<fcl::OBBRSSd> first_, second_;
};

}  // namespace

std::unique_ptr<MeshPeer> makeFclMeshes(const TriangleMesh& first, const TriangleMesh& second) {
  return std::make_unique<FclMeshes>(first, second);
}

}  // namespace bench
}  // namespace hgrid
