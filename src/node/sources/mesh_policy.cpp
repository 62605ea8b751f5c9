// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/mesh_policy.h"

#include <dlfcn.h>
#include <ros/package.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace hgrid {
namespace {

constexpr int kMeshTimeouts = 4;  // all files of a loader together have this many times the timeout of one file

/// Returns the path of the helper executable that reads meshes. It is in the folder hgrid_proximity/, which is next to
/// this library.
std::string meshReader() {
  Dl_info info{};
  const auto here = reinterpret_cast<void*>(&meshReader);
  std::string library = dladdr(here, &info) != 0 && info.dli_fname != nullptr ? info.dli_fname : "";
  if (char* resolved = realpath(library.c_str(), nullptr)) {
    library = resolved;
    std::free(resolved);
  }
  return library.substr(0, library.find_last_of('/')) + "/hgrid_proximity/proximity_mesh_reader";
}

/// Returns the folders in which file:// may read files: the folders of ROS_PACKAGE_PATH and ~mesh_roots.
std::vector<std::string> fileRoots(const Params& params) {
  std::vector<std::string> roots = params.mesh_roots;
  const char* path = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) roots.push_back(folder);
  }
  return roots;
}

}  // namespace

MeshPolicy meshPolicy(const Params& params, const std::function<bool()>& cancelled) {
  MeshPolicy policy;
  policy.cancelled = cancelled;
  policy.reader = meshReader();
  policy.resources.package_path = [](const std::string& package) { return ros::package::getPath(package); };
  policy.resources.file_roots = fileRoots(params);
  policy.resources.max_bytes = static_cast<std::size_t>(params.max_mesh_bytes);
  policy.max_triangles = static_cast<std::size_t>(params.max_mesh_triangles);
  policy.timeout = std::chrono::milliseconds(std::llround(1e3 * params.mesh_timeout));
  policy.total = kMeshTimeouts * policy.timeout;
  policy.max_memory = static_cast<std::size_t>(params.mesh_memory);
  return policy;
}

}  // namespace hgrid
