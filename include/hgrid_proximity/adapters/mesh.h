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

/// How meshes are read.
struct MeshPolicy {
  std::string reader;  ///< path of the helper executable proximity_mesh_reader
  ResourcePolicy resources;
  std::size_t max_triangles = 1000000;
  std::chrono::milliseconds timeout{5000};  ///< per file; then the helper is killed
  std::size_t max_memory = 512u << 20;      ///< [bytes] address space of the helper
  std::function<bool()> cancelled;          ///< asked at least every 50 ms; once it returns true, reading is given up
};

/// Reads STL, DAE and OBJ files in a helper process, since the library that parses them may crash or hang
/// on a broken file: the helper gets the open file, limits on memory, time and files, and nothing else.
/// What comes back is checked again. A file is read once for each loader, however often it is asked for.
/// Not for several threads at once.
class MeshLoader {
 public:
  explicit MeshLoader(MeshPolicy policy) : policy_(std::move(policy)) {}

  /// The triangles of a file, each coordinate times `scale`; a mirroring scale turns the triangles round, so
  /// that they still face outward.
  /// @throws Refusal resource_denied, resource_missing, unsupported, limit, budget, parse, truncated (the
  /// helper died), nonfinite, out_of_range, bad_geometry, internal (the helper answered with something else), busy (it
  /// was cancelled)
  std::shared_ptr<const TriangleMesh> load(const std::string& uri, const Eigen::Vector3d& scale);

 private:
  MeshPolicy policy_;
  std::map<std::string, std::shared_ptr<const TriangleMesh>> read_;  // by real path, unscaled
};

}  // namespace hgrid
