// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <memory>

namespace hgrid {

/// Detects that the ROS master ends this node because another node has registered under the same name.
///
/// Another master may send the same request to this node by mistake: if a node of its own ended without unregistering
/// and started again, and this node now uses the port of the process that ended. Therefore the master of this node is
/// asked who has the name. While this node has it, the request is ignored, with a warning.
class NameWatch {
 public:
  /// Exit code of the process if another node has taken the name of this node.
  static constexpr int kExitCode = 3;

  /// Handles shutdown requests of the master instead of roscpp. Construct it before the first ros::NodeHandle.
  NameWatch();

  /// Returns whether another node has taken the name of this node. Any thread may call this.
  bool nameTaken() const { return *taken_; }

 private:
  std::shared_ptr<std::atomic<bool>> taken_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace hgrid
