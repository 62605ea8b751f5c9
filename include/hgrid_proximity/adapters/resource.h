// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace hgrid {

/// Which files a description may name.
struct ResourcePolicy {
  /// Folder of a package, empty if there is none of that name.
  std::function<std::string(const std::string& package)> package_path;
  /// Folders below which file:// may read, and where links in a package may lead; links are resolved before
  /// comparing.
  std::vector<std::string> file_roots;
  std::size_t max_bytes = 64u << 20;
};

/// A regular file that the policy allows, open for reading; closed on destruction.
class OpenResource {
 public:
  OpenResource(int fd, std::string path, std::size_t bytes) : fd_(fd), path_(std::move(path)), bytes_(bytes) {}
  ~OpenResource();
  OpenResource(OpenResource&& other) noexcept;
  OpenResource& operator=(OpenResource&&) = delete;

  int fd() const { return fd_; }
  const std::string& path() const { return path_; }  ///< real path, links resolved
  std::size_t bytes() const { return bytes_; }

 private:
  int fd_;
  std::string path_;
  std::size_t bytes_;
};

/// Opens `package://name/path` or `file:///path`. Nothing else is ever opened: no network, no device, no
/// FIFO, nothing outside the package or the roots, whatever links say.
/// @throws Refusal resource_denied, resource_missing, limit
OpenResource openResource(const std::string& uri, const ResourcePolicy& policy);

}  // namespace hgrid
