// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/resource.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestUri = 4096;

[[noreturn]] void deny(const std::string& uri, const std::string& rule) {
  throw Refusal(Code::resource_denied, "resource '" + printable(uri) + "' is denied: " + rule);
}

/// Throws that a resource cannot be used.
/// @param what   what is wrong, such as "cannot be opened: No such file or directory"
/// @param error  the error number of the system. If it means that no further file can be opened, the sentence says that
[[noreturn]] void refuse(const std::string& uri, const std::string& what, int error) {
  const std::string resource = "resource '" + printable(uri) + "'";
  if (error != EMFILE && error != ENFILE) throw Refusal(Code::resource_missing, resource + what);
  throw Refusal(Code::limit, resource + " cannot be opened: this process may open no further file (" +
                                 std::strerror(error) + "); raise its limit (ulimit -n, or LimitNOFILE of systemd)");
}

/// Returns the error number with which the system refuses to open any file, such as EMFILE; 0: it does not.
int errorOfAnyFile() {
  const OpenResource root(open("/", O_PATH | O_CLOEXEC), "/", 0);
  return root.fd() < 0 ? errno : 0;
}

/// Returns the path with all symbolic links resolved, or an empty text if the path does not exist.
std::string realFolder(const std::string& path) {
  char resolved[PATH_MAX];
  return !path.empty() && realpath(path.c_str(), resolved) != nullptr ? resolved : "";
}

bool isBelow(const std::string& path, const std::string& real_folder) {
  return !real_folder.empty() &&
         (real_folder == "/" || path.compare(0, real_folder.size() + 1, real_folder + "/") == 0);
}

bool startsWith(const std::string& text, const char* prefix) {
  return text.compare(0, std::strlen(prefix), prefix) == 0;
}

/// Whether the ".." parts of a relative path lead out of the folder where the path starts. This function looks only at
/// the text of the path, not at the disk.
bool leadsOut(const std::string& relative) {
  int depth = 0;
  for (std::size_t begin = 0; begin < relative.size();) {
    std::size_t end = relative.find('/', begin);
    if (end == std::string::npos) end = relative.size();
    const std::string part = relative.substr(begin, end - begin);
    if (part == "..") {
      if (--depth < 0) return true;
    } else if (!part.empty() && part != ".") {
      ++depth;
    }
    begin = end + 1;
  }
  return false;
}

/// The file that a URI names, and the folders in which it may be.
struct Place {
  std::string path;                // path of the file to open
  std::vector<std::string> roots;  // real paths of folders; one of them must contain the file
};

Place placeOf(const std::string& uri, const ResourcePolicy& policy) {
  if (uri.size() > kLongestUri) deny(uri, "its name is longer than " + std::to_string(kLongestUri) + " bytes");
  if (uri.find('\0') != std::string::npos) deny(uri, "its name must not contain a zero byte");
  if (startsWith(uri, "package://")) {
    const std::string rest = uri.substr(std::strlen("package://"));
    const std::size_t slash = rest.find('/');
    const std::string package = rest.substr(0, slash);
    if (slash == std::string::npos || package.empty() || package == "..") deny(uri, "it must be package://name/path");
    const std::string relative = rest.substr(slash + 1);
    if (leadsOut(relative)) deny(uri, "it must not lead out of package '" + printable(package) + "'");
    const std::string folder = policy.package_path ? policy.package_path(package) : "";
    const std::string real = realFolder(folder);
    if (real.empty()) refuse(uri, ": there is no package '" + printable(package) + "'", errorOfAnyFile());
    Place place{real + "/" + relative, {real}};
    for (const std::string& root : policy.file_roots) place.roots.push_back(realFolder(root));
    return place;
  }
  if (startsWith(uri, "file:///")) {
    Place place{uri.substr(std::strlen("file://")), {}};
    for (const std::string& root : policy.file_roots) place.roots.push_back(realFolder(root));
    return place;
  }
  deny(uri, "it must begin with package:// or file:///");
}

}  // namespace

OpenResource::~OpenResource() {
  if (fd_ >= 0) close(fd_);
}

OpenResource::OpenResource(OpenResource&& other) noexcept
    : fd_(other.fd_), path_(std::move(other.path_)), bytes_(other.bytes_) {
  other.fd_ = -1;
}

OpenResource openResource(const std::string& uri, const ResourcePolicy& policy) {
  const Place place = placeOf(uri, policy);
  // O_PATH finds the file without opening it. So this call touches no device and waits for no FIFO. After the checks,
  // the file is opened through /proc. This opens the checked file, even if its name was changed in the meantime.
  const OpenResource looked(open(place.path.c_str(), O_PATH | O_CLOEXEC), place.path, 0);
  if (looked.fd() < 0) refuse(uri, std::string(" cannot be opened: ") + std::strerror(errno), errno);
  const std::string handle = "/proc/self/fd/" + std::to_string(looked.fd());
  const std::string real = realFolder(handle);
  bool below = false;
  for (const std::string& root : place.roots) below = below || isBelow(real, root);
  if (!below) deny(uri, "it is outside the folders that may be read");
  struct stat status {};
  if (fstat(looked.fd(), &status) != 0 || !S_ISREG(status.st_mode)) deny(uri, "it is not a regular file");
  const auto bytes = static_cast<std::size_t>(status.st_size);
  if (bytes > policy.max_bytes) {
    throw Refusal(Code::limit, "resource '" + printable(uri) + "' has " + std::to_string(bytes) + " bytes; at most " +
                                   std::to_string(policy.max_bytes) + " are allowed");
  }
  const int fd = open(handle.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) refuse(uri, std::string(" cannot be read: ") + std::strerror(errno), errno);
  return OpenResource(fd, real, bytes);
}

}  // namespace hgrid
