// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "node/state/state_files.h"
#include "node/state/state_log.h"

namespace hgrid {

/// The files of ~state_folder. "state" holds the newest state. "state.previous" is its predecessor. "state.damaged" is
/// the newest file that could not be read completely. "lock" keeps other processes out.
///
/// All functions throw Refusal resource_denied if the system refuses an operation; the sentence names the file and why.
class StateFolder {
 public:
  /// Opens the folder, and creates it if it does not exist. Its parent must exist.
  /// @param patience  how long to wait for another process that is about to end
  /// @throws Refusal conflict if another process uses the folder; resource_denied also if another user could write into
  /// the folder or owns it
  StateFolder(const std::string& path, std::chrono::milliseconds patience);

  /// What the files contain.
  struct Found {
    StateItems items;
    std::string damage;  ///< empty: nothing is lost; otherwise a sentence that says which file is damaged and where
  };
  /// Reads the newest state; if it cannot be used at all, its predecessor.
  /// @throws also Refusal unsupported if the file is of another version
  Found read() const;
  /// Replaces the file by a new one. If the system crashes, the old file or the new one is there,
  /// and it is complete.
  void replace(const StateItems& items);
  /// Keeps the newest file as "state.damaged". Call this before replace() if read() found damage.
  void keepDamaged();
  /// Appends a record. When this returns, the record is on disk. If it throws, call replace() before the next append().
  void append(const std::vector<StateEdit>& edits);
  /// Number of bytes in the file, and number of bytes that replace() wrote.
  std::size_t size() const { return size_; }
  std::size_t sizeAtFirst() const { return size_at_first_; }

 private:
  std::string pathOf(const std::string& file) const { return path_ + "/" + file; }
  void keepAs(const char* name) const;
  void synchronize() const;

  const std::string path_;
  Descriptor folder_, lock_, file_;
  std::size_t size_ = 0, size_at_first_ = 0;
};

}  // namespace hgrid
