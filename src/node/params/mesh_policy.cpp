// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/mesh_policy.h"

#include <dlfcn.h>
#include <link.h>
#include <ros/package.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace hgrid {
namespace {

constexpr int kMeshTimeouts = 4;  // all files of a loader together have this many times the timeout of one file

/// Returns the folder of the file that contains this code: the node's library, or a program or nodelet that it was
/// linked into. Ends with a slash.
std::string ownFolder() {
  Dl_info info{};
  void* map = nullptr;
  if (dladdr1(reinterpret_cast<void*>(&ownFolder), &info, &map, RTLD_DL_LINKMAP) == 0) return "";
  std::string file = static_cast<const link_map*>(map)->l_name;
  if (file.empty()) file = "/proc/self/exe";  // the program itself has no name here
  if (char* resolved = realpath(file.c_str(), nullptr)) {
    file = resolved;
    std::free(resolved);
  }
  return file.substr(0, file.find_last_of('/') + 1);
}

/// Returns the path of the helper executable that reads meshes. Programs are in lib/hgrid_proximity/, libraries in
/// lib/. Only in packages of Debian, the nodelet is in lib/<architecture>/ros/.
std::string meshReader() {
  const std::string here = ownFolder();
  for (const char* folder : {"", "../../hgrid_proximity/"}) {
    const std::string reader = here + folder + "proximity_mesh_reader";
    if (access(reader.c_str(), X_OK) == 0) return reader;
  }
  return here + "hgrid_proximity/proximity_mesh_reader";
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
