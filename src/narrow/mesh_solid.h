// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "hgrid_proximity/geometry/sphere.h"
#include "narrow/distance_lattice.h"
#include "narrow/enclosure.h"
#include "narrow/mesh_tree.h"
#include "narrow/ordered_solid.h"

namespace hgrid {

/// A mesh that is prepared for measuring. All solids of one mesh share it.
struct PreparedMesh {
  explicit PreparedMesh(std::shared_ptr<const TriangleMesh> mesh)
      : source(std::move(mesh)), tree(*source), enclosure(*source) {}

  std::shared_ptr<const TriangleMesh> source;  // kept, so that no other mesh gets its address
  /// Returns spheres inside the mesh; any thread may call this.
  const std::vector<Sphere>& innerSpheres() const;
  /// Returns bounds of distances from the mesh; null if it is not Enclosure::simple(), or until countApart() makes
  /// them. Any thread may call this.
  const DistanceLattice* lattice() const { return lattice_.load(std::memory_order_acquire); }
  /// Counts a measurement of the mesh that found no contact. One of the calls, after some hundreds, makes lattice().
  /// This call takes milliseconds longer; meanwhile other threads go on without. Any thread may call this.
  void countApart() const;

  MeshTree tree;
  Enclosure enclosure;

 private:
  mutable std::once_flag spheres_found_;
  mutable std::vector<Sphere> spheres_;
  mutable std::atomic<std::uint32_t> apart_{0};
  mutable std::unique_ptr<const DistanceLattice> made_;
  mutable std::atomic<const DistanceLattice*> lattice_{nullptr};  // made_, when it is complete
};

/// A mesh as a solid.
class MeshSolid final : public OrderedSolid {
 public:
  MeshSolid(const Shape& shape, std::shared_ptr<const PreparedMesh> mesh)
      : OrderedSolid(shape), mesh_(std::move(mesh)) {}
  const MeshTree& tree() const { return mesh_->tree; }
  const Enclosure& enclosure() const { return mesh_->enclosure; }
  const std::vector<Sphere>& innerSpheres() const { return mesh_->innerSpheres(); }
  const DistanceLattice* lattice() const { return mesh_->lattice(); }
  void countApart() const { mesh_->countApart(); }

 private:
  std::shared_ptr<const PreparedMesh> mesh_;
};

/// Prepares each mesh once, as long as a solid uses it. Several threads may use it.
class PreparedMeshes {
 public:
  std::shared_ptr<const PreparedMesh> of(const std::shared_ptr<const TriangleMesh>& mesh);

 private:
  std::mutex mutex_;
  std::map<const TriangleMesh*, std::weak_ptr<const PreparedMesh>> meshes_;
};

}  // namespace hgrid
