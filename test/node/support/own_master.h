// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "child_process.h"

namespace hgrid {
namespace test {

/// A separate ROS master for one test. It runs in its own process, which the test may stop.
class OwnMaster {
 public:
  /// Starts the master and waits for its first answer. @throws std::runtime_error after 20 s
  OwnMaster();

  ChildProcess& process() { return *process_; }
  /// Returns the value of ROS_MASTER_URI for nodes that use this master.
  std::string uri() const { return "http://127.0.0.1:" + std::to_string(port_); }
  /// Returns the registrations of a node at this master, as registrationsOf() lists them, such as "publishes /a/b".
  std::vector<std::string> registrations(const std::string& node) const;
  /// Waits until the registrations of the node contain `what`, such as "publishes /a/b".
  /// @throws std::runtime_error after 20 s
  void waitForRegistration(const std::string& node, const std::string& what) const;

 private:
  int port_;
  std::unique_ptr<ChildProcess> process_;
};

/// Returns a TCP port of 127.0.0.1 on which nobody listens. Linux gives it to no other process in the meantime, unless
/// that process asks for this port. Does the same as scripts/free_port.
int freePort();

}  // namespace test
}  // namespace hgrid
