// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/state_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

/// @throws Refusal resource_denied if another user could change the files
void checkOwner(int folder, const std::string& path) {
  struct stat about {};
  if (::fstat(folder, &about) != 0) failFile("read", path);
  if (about.st_uid == ::geteuid() && (about.st_mode & (S_IWGRP | S_IWOTH)) == 0) return;
  throw Refusal(Code::resource_denied, "the folder '" + printable(path, 300) +
                                           "' belongs to another user, or other users may write into it; give it to "
                                           "the user of the node with chown, and use chmod go-w");
}

[[noreturn]] void failSize(const std::string& path, std::size_t most) {
  throw Refusal(Code::limit, "the file '" + printable(path, 300) + "' has more than " + std::to_string(most) +
                                 " bytes, the largest size that is read");
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

void failFile(const std::string& what, const std::string& path) {
  const std::string why = std::strerror(errno);
  throw Refusal(Code::resource_denied, "cannot " + what + " '" + printable(path, 300) + "': " + why);
}

void writeAll(int file, const std::string& bytes, const std::string& path) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) failFile("write", path);
    done += static_cast<std::size_t>(count);
  }
}

std::optional<OpenFile> openFile(int folder, const std::string& name, const std::string& path, std::size_t most) {
  // O_NONBLOCK: opening a pipe without it would wait for a writer. It changes nothing for a regular file.
  Descriptor file(::openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.get() < 0 && errno == ENOENT) return std::nullopt;
  if (file.get() < 0 && errno == ELOOP) {
    throw Refusal(Code::resource_denied,
                  "'" + printable(path, 300) + "' is a link, which is not followed; put the file itself there");
  }
  struct stat about {};
  if (file.get() < 0 || ::fstat(file.get(), &about) != 0) failFile("read", path);
  if (!S_ISREG(about.st_mode)) {
    throw Refusal(Code::resource_denied, "'" + printable(path, 300) + "' is no regular file");
  }
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size > most) failSize(path, most);
  return OpenFile{std::move(file), size, about.st_mtim};
}

std::optional<std::string> bytesOf(int folder, const std::string& name, const std::string& path, std::size_t most) {
  const std::optional<OpenFile> file = openFile(folder, name, path, most);
  if (!file) return std::nullopt;
  std::string bytes;
  char part[1 << 16];
  while (true) {
    const ssize_t count = ::read(file->descriptor.get(), part, sizeof part);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failFile("read", path);
    if (count == 0) return bytes;
    bytes.append(part, static_cast<std::size_t>(count));
    if (bytes.size() > most) failSize(path, most);  // it grows while it is read
  }
}

Descriptor openOwnFolder(const std::string& path) {
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) failFile("create the folder", path);
  // The name of a new folder must be on disk, too. An earlier process may have ended before it was.
  const Descriptor parent(::open((path + "/..").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (parent.get() < 0 || ::fsync(parent.get()) != 0) failFile("write the folder above", path);
  Descriptor folder(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0) failFile("open the folder", path);
  checkOwner(folder.get(), path);
  return folder;
}

}  // namespace hgrid
