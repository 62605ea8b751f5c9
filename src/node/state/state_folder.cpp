// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <limits>
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
constexpr std::size_t kAnySize = std::numeric_limits<std::size_t>::max();

}  // namespace

StateFolder::StateFolder(const std::string& path, std::chrono::milliseconds patience) : path_(path) {
  folder_ = openOwnFolder(path);
  lock_ = Descriptor(::openat(folder_.get(), "lock", O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600));
  if (lock_.get() < 0) failFile("create", pathOf("lock"));
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (::flock(lock_.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) failFile("lock", pathOf("lock"));
    if (std::chrono::steady_clock::now() > deadline) {
      throw Refusal(Code::conflict, "another process uses the folder '" + printable(path, 300) +
                                        "'; each node needs a folder of its own");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

StateFolder::Found StateFolder::read() const {
  Found found;
  const std::optional<std::string> newest = bytesOf(folder_.get(), kNewest, pathOf(kNewest), kAnySize);
  if (newest) {
    StateContent content = readState(*newest);
    if (content.damage.empty() && content.records == 0) content.damage = "it is not complete";
    if (!content.damage.empty()) found.damage = "the file '" + pathOf(kNewest) + "' is damaged: " + content.damage;
    if (content.records > 0) {
      found.items = std::move(content.items);
      return found;
    }
  }
  const std::optional<std::string> previous = bytesOf(folder_.get(), kPrevious, pathOf(kPrevious), kAnySize);
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
  if (next.get() < 0) failFile("create", pathOf(kNew));
  writeAll(next.get(), bytes, pathOf(kNew));
  if (::fsync(next.get()) != 0) failFile("write", pathOf(kNew));
  keepAs(kPrevious);
  if (::renameat(folder_.get(), kNew, folder_.get(), kNewest) != 0) failFile("replace", pathOf(kNewest));
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
  if (::fdatasync(file_.get()) != 0) failFile("write", pathOf(kNewest));
  size_ += bytes.size();
}

/// Writes the names of the files to disk.
void StateFolder::synchronize() const {
  if (::fsync(folder_.get()) != 0) failFile("write", path_);
}

}  // namespace hgrid
