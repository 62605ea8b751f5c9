// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr const char* kNewest = "state";
constexpr const char* kPrevious = "state.previous";
constexpr const char* kDamaged = "state.damaged";
constexpr const char* kNew = "state.new";

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const std::string why = std::strerror(errno);
  throw Refusal(Code::resource_denied, "cannot " + what + " '" + printable(path, 300) + "': " + why);
}

void writeAll(int file, const std::string& bytes, const std::string& path) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail("write", path);
    done += static_cast<std::size_t>(count);
  }
}

/// Returns the bytes of a file; nullopt if it does not exist.
std::optional<std::string> bytesOf(int folder, const char* name, const std::string& path) {
  const Descriptor file(::openat(folder, name, O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  if (file.get() < 0 && errno == ENOENT) return std::nullopt;
  if (file.get() < 0) fail("read", path);
  std::string bytes;
  char part[1 << 16];
  while (true) {
    const ssize_t count = ::read(file.get(), part, sizeof part);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("read", path);
    if (count == 0) return bytes;
    bytes.append(part, static_cast<std::size_t>(count));
  }
}

/// @throws Refusal resource_denied if another user could change the files
void checkOwner(int folder, const std::string& path) {
  struct stat about {};
  if (::fstat(folder, &about) != 0) fail("read", path);
  if (about.st_uid == ::geteuid() && (about.st_mode & (S_IWGRP | S_IWOTH)) == 0) return;
  throw Refusal(Code::resource_denied, "the folder '" + printable(path, 300) +
                                           "' belongs to another user, or other users may write into it; give it to "
                                           "the user of the node with chown, and use chmod go-w");
}

}  // namespace

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

StateFolder::StateFolder(const std::string& path, std::chrono::milliseconds patience) : path_(path) {
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) fail("create the folder", path);
  // The name of a new folder must be on disk, too. An earlier process may have ended before it was.
  const Descriptor parent(::open((path + "/..").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (parent.get() < 0 || ::fsync(parent.get()) != 0) fail("write the folder above", path);
  folder_ = Descriptor(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder_.get() < 0) fail("open the folder", path);
  checkOwner(folder_.get(), path);
  lock_ = Descriptor(::openat(folder_.get(), "lock", O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (lock_.get() < 0) fail("create", pathOf("lock"));
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) fail("lock", pathOf("lock"));
    if (std::chrono::steady_clock::now() > deadline) {
      throw Refusal(Code::conflict, "another process uses the folder '" + printable(path, 300) +
                                        "'; each node needs a folder of its own");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

StateFolder::Found StateFolder::read() const {
  Found found;
  const std::optional<std::string> newest = bytesOf(folder_.get(), kNewest, pathOf(kNewest));
  if (newest) {
    StateContent content = readState(*newest);
    if (content.damage.empty() && content.records == 0) content.damage = "it is not complete";
    if (!content.damage.empty()) found.damage = "the file '" + pathOf(kNewest) + "' is damaged: " + content.damage;
    if (content.records > 0) {
      found.items = std::move(content.items);
      return found;
    }
  }
  const std::optional<std::string> previous = bytesOf(folder_.get(), kPrevious, pathOf(kPrevious));
  if (!previous) return found;
  if (!newest) found.damage = "the file '" + pathOf(kNewest) + "' is missing";
  StateContent content = readState(*previous);
  found.items = std::move(content.items);
  found.damage += content.records > 0 ? "; its predecessor is used" : "; its predecessor is damaged, too";
  return found;
}

void StateFolder::replace(const StateItems& items) {
  const std::string bytes = beginningOf(items);
  ::unlinkat(folder_.get(), kNew, 0);
  Descriptor next(::openat(folder_.get(), kNew, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_APPEND | O_CLOEXEC, 0600));
  if (next.get() < 0) fail("create", pathOf(kNew));
  writeAll(next.get(), bytes, pathOf(kNew));
  if (::fsync(next.get()) != 0) fail("write", pathOf(kNew));
  keepAs(kPrevious);
  if (::renameat(folder_.get(), kNew, folder_.get(), kNewest) != 0) fail("replace", pathOf(kNewest));
  synchronize();
  file_ = std::move(next);
  size_ = size_at_first_ = bytes.size();
}

void StateFolder::keepDamaged() { keepAs(kDamaged); }

/// Gives the newest file a second name, under which it stays when replace() gives its first name to a new file. Some
/// file systems do not allow second names. This is not an error: the second name is needed only if the new file gets
/// damaged.
void StateFolder::keepAs(const char* name) const {
  const std::string next = std::string(name) + ".new";
  ::unlinkat(folder_.get(), next.c_str(), 0);
  if (::linkat(folder_.get(), kNewest, folder_.get(), next.c_str(), 0) != 0) return;
  ::renameat(folder_.get(), next.c_str(), folder_.get(), name);
  ::unlinkat(folder_.get(), next.c_str(), 0);  // rename() does nothing if both names are of the same file
}

void StateFolder::append(const std::vector<StateEdit>& edits) {
  const std::string bytes = recordOf(edits);
  writeAll(file_.get(), bytes, pathOf(kNewest));
  if (::fdatasync(file_.get()) != 0) fail("write", pathOf(kNewest));
  size_ += bytes.size();
}

/// Writes the names of the files to disk.
void StateFolder::synchronize() const {
  if (::fsync(folder_.get()) != 0) fail("write", path_);
}

}  // namespace hgrid
