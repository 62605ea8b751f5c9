// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace hgrid {

/// Says which files a robot description or a map source may read.
struct ResourcePolicy {
  /// Returns the folder of a package, or an empty text if there is no package of this name.
  std::function<std::string(const std::string& package)> package_path;
  /// Folders from which file:// URIs may read. Symbolic links in a package may also lead to these folders. Symbolic
  /// links are resolved before a path is compared with these folders.
  std::vector<std::string> file_roots;
  std::size_t max_bytes = 64u << 20;  ///< largest size of a file
};

/// A regular file that the policy allows, open for reading. The destructor closes it.
class OpenResource {
 public:
  /// Takes over an open file.
  /// @param fd     file descriptor, which the destructor closes
  /// @param path   path of the file with all symbolic links resolved
  /// @param bytes  size of the file
  OpenResource(int fd, std::string path, std::size_t bytes) : fd_(fd), path_(std::move(path)), bytes_(bytes) {}
  ~OpenResource();
  /// Takes over the file of `other`.
  OpenResource(OpenResource&& other) noexcept;
  OpenResource& operator=(OpenResource&&) = delete;

  int fd() const { return fd_; }                     ///< file descriptor, owned by this object
  const std::string& path() const { return path_; }  ///< path with all symbolic links resolved
  std::size_t bytes() const { return bytes_; }       ///< [bytes] size of the file when it was opened

 private:
  int fd_;
  std::string path_;
  std::size_t bytes_;
};

/// Opens `package://name/path` or `file:///path`. It never opens a network address, a device, a FIFO, or a file outside
/// the package and the allowed folders, even if a symbolic link leads there.
/// @throws Refusal resource_denied if the policy does not allow the file
/// @throws Refusal resource_missing if the package or the file does not exist or cannot be read
/// @throws Refusal limit if the file is too large
OpenResource openResource(const std::string& uri, const ResourcePolicy& policy);

}  // namespace hgrid
