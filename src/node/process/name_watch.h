// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <memory>

namespace hgrid {

/// Detects that the ROS master ends this node because another node has registered under the same name.
///
/// A master may send the same request to this node by mistake. This happens if some node ended without unregistering
/// and was started again, and this node got the port that the ended process had used. Therefore this node asks its own
/// master who has the name of this node. If this node still has it, or the master does not answer, this node logs a
/// warning and ignores the request.
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
