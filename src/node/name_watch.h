// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <memory>

namespace hgrid {

/// Notices when the master ends this node because another node has registered under its name.
class NameWatch {
 public:
  /// Exit code of a node whose name another node has taken.
  static constexpr int kExitCode = 3;

  /// Handles the master's requests to shut down in place of roscpp. Construct this before the first ros::NodeHandle.
  NameWatch();

  /// Whether another node has taken the name. Any thread.
  bool nameTaken() const { return *taken_; }

 private:
  std::shared_ptr<std::atomic<bool>> taken_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace hgrid
