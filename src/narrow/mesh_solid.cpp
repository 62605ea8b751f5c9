// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/mesh_solid.h"

#include <iterator>
#include <new>

#include "narrow/inner_spheres.h"

namespace hgrid {
namespace {

// Number of measurements without contact after which the lattice is made. Making it takes about as long as ten times as
// many measurements. But whoever asks for one state of a robot usually asks for thousands, so it is worth its time.
constexpr std::uint32_t kWorthLattice = 300;

}  // namespace

void PreparedMesh::countApart() const {
  if (!enclosure.simple() || apart_.load(std::memory_order_relaxed) > kWorthLattice) return;
  if (apart_.fetch_add(1, std::memory_order_relaxed) != kWorthLattice) return;
  try {
    made_ = std::make_unique<const DistanceLattice>(tree.triangles());
    lattice_.store(made_.get(), std::memory_order_release);
  } catch (const std::bad_alloc&) {  // the mesh is measured without a lattice, as before
  }
}

const std::vector<Sphere>& PreparedMesh::innerSpheres() const {
  std::call_once(spheres_found_, [this] {
    Eigen::Vector3d low = source->vertices.front(), high = low;
    for (const auto& triangle : source->triangles) {
      for (const std::uint32_t corner : triangle) {
        low = low.cwiseMin(source->vertices[corner]);
        high = high.cwiseMax(source->vertices[corner]);
      }
    }
    spheres_ = innerSpheresOf(tree, enclosure, low, high);
  });
  return spheres_;
}

std::shared_ptr<const PreparedMesh> PreparedMeshes::of(const std::shared_ptr<const TriangleMesh>& mesh) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (auto known = meshes_[mesh.get()].lock()) return known;
  }
  auto made = std::make_shared<const PreparedMesh>(mesh);  // slow, so it runs without the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto known = meshes_.begin(); known != meshes_.end();) {
    known = known->second.expired() ? meshes_.erase(known) : std::next(known);
  }
  meshes_[mesh.get()] = made;
  return made;
}

}  // namespace hgrid
