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

/// Runs a program in a child process and writes its standard output and standard error to a file.
///
/// The destructor ends the process: it sends SIGINT, and SIGKILL if the process still runs after 10 s.
class ChildProcess {
 public:
  /// Starts the program.
  /// @param command      program (searched in PATH if it contains no slash) and arguments
  /// @param output_file  the output of the program is appended to this file
  /// @param environment  variables that are added to the environment of the test
  /// @throws std::runtime_error if the program cannot be started
  ChildProcess(const std::vector<std::string>& command, const std::string& output_file,
               const std::map<std::string, std::string>& environment);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  bool alive() { return !waitForEnd(0.0); }
  void signal(int number) const;
  /// Waits at most `patience` [s] for the end of the process.
  /// @returns its exit code, or 128 + n if signal n ended it; nullopt if it still runs
  std::optional<int> waitForEnd(double patience);

 private:
  pid_t pid_ = -1;
  std::optional<int> code_;
};

}  // namespace test
}  // namespace hgrid
