// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <time.h>

#include <cstddef>
#include <optional>
#include <string>

namespace hgrid {

/// A file descriptor that is closed when this object is destroyed.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  int get() const { return number_; }

 private:
  int number_;
};

/// @throws Refusal resource_denied, with the reason that the system gave for its last refusal
[[noreturn]] void failFile(const std::string& what, const std::string& path);

/// Opens a folder that only this user can change, and creates it if it does not exist. Its parent must exist.
/// @throws Refusal resource_denied
Descriptor openOwnFolder(const std::string& path);

/// Writes all bytes. @throws Refusal resource_denied
void writeAll(int file, const std::string& bytes, const std::string& path);

/// An open file in a folder.
struct OpenFile {
  Descriptor descriptor;
  std::size_t size;     ///< [byte]
  timespec last_write;  ///< since the beginning of 1970, UTC
};
/// Opens a file in a folder for reading; nullopt if it does not exist. @param path  of the file, for error sentences
/// @throws Refusal resource_denied, also if it is a link or no regular file; limit if it has more bytes than `most`
std::optional<OpenFile> openFile(int folder, const std::string& name, const std::string& path, std::size_t most);

/// Returns the bytes of a file in a folder; nullopt if it does not exist. The rest is as above.
std::optional<std::string> bytesOf(int folder, const std::string& name, const std::string& path, std::size_t most);

}  // namespace hgrid
