// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "child_process.h"

namespace hgrid {
namespace test {

/// A ROS master of the test's own, in a process that the test may stop. Waiting is for the answers of that master.
class OwnMaster {
 public:
  OwnMaster();

  ChildProcess& process() { return *process_; }
  /// The value of ROS_MASTER_URI for nodes of this master.
  std::string uri() const { return "http://127.0.0.1:" + std::to_string(port_); }
  /// See registrationsOf().
  std::vector<std::string> registrations(const std::string& node) const;
  /// @throws std::runtime_error after 20 s
  void waitForRegistration(const std::string& node, const std::string& what) const;

 private:
  int port_;
  std::unique_ptr<ChildProcess> process_;
};

/// A TCP port of 127.0.0.1 that nobody listens to.
int freePort();

}  // namespace test
}  // namespace hgrid
