// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hgrid {
namespace test {

/// A program in a process of its own, output and errors in a file. Ends with this object, whatever state it is in.
class ChildProcess {
 public:
  /// @param command      program (searched in PATH if it has no slash) and arguments
  /// @param environment  added to this process's own
  ChildProcess(const std::vector<std::string>& command, const std::string& output_file,
               const std::map<std::string, std::string>& environment);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  bool alive() { return !waitForEnd(0.0); }
  void signal(int number) const;
  /// Its exit code (128 + n if signal n ended it), or nothing if it still runs after `patience` [s].
  std::optional<int> waitForEnd(double patience);

 private:
  pid_t pid_ = -1;
  std::optional<int> code_;
};

}  // namespace test
}  // namespace hgrid
