// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "hgrid_proximity/adapters/resource.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

/// Settings and limits for reading mesh files.
struct MeshPolicy {
  std::string reader;                       ///< path of the helper executable proximity_mesh_reader
  ResourcePolicy resources;                 ///< which files may be read
  std::size_t max_triangles = 1000000;      ///< largest number of triangles in one file
  std::chrono::milliseconds timeout{5000};  ///< time per file; afterwards the helper is killed
  std::chrono::milliseconds total{20000};   ///< time for all files of a loader; then it refuses files not yet read
  std::size_t max_memory = 512u << 20;      ///< [bytes] limit for the address space of the helper
  std::function<bool()> cancelled;          ///< called at least every 50 ms; reading stops once it returns true
};

/// Reads STL, DAE and OBJ files in a helper process.
///
/// The helper is needed because reading a broken file may crash or take too long. The helper can access only the
/// open file, and its memory, time and files are limited. The loader checks the result again. A loader reads each file
/// only once. Only one thread may use a loader at a time.
class MeshLoader {
 public:
  /// Creates a loader that has not read any file yet.
  explicit MeshLoader(MeshPolicy policy) : policy_(std::move(policy)) {}

  /// Returns the triangles of a file, with each coordinate multiplied by `scale`. If `scale` mirrors the mesh, the
  /// order of the corners is reversed, so that the triangles still face outward.
  /// @throws Refusal with one of these codes:
  /// - resource_denied, resource_missing, limit: see openResource(); limit also if there are too many triangles
  /// - unsupported, parse: the file is of another kind, it cannot be parsed, or a part of its surface would be missing
  /// - nonfinite, out_of_range, bad_geometry: the scale or the mesh is not valid
  /// - budget: reading took longer than the timeout
  /// - truncated: the helper ended too early
  /// - internal: the helper returned invalid data
  /// - busy: reading was canceled
  std::shared_ptr<const TriangleMesh> load(const std::string& uri, const Eigen::Vector3d& scale);

 private:
  std::shared_ptr<const TriangleMesh> read(const OpenResource& file, const std::string& what);

  MeshPolicy policy_;
  std::chrono::steady_clock::duration spent_{0};                     // time for reading files so far
  std::map<std::string, std::shared_ptr<const TriangleMesh>> read_;  // unscaled meshes by OpenResource::path()
};

}  // namespace hgrid
