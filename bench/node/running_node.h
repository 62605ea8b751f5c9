// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

#include "listener.h"
#include "test/node/support/child_process.h"
#include "tf_publisher.h"
#include "workload.h"

namespace hgrid {
namespace bench {

/// A node in a process of its own that lives in a workload, which moves.
class RunningNode {
 public:
  /// Starts it, and lets it run until it is as slow as it gets.
  /// @param watched  [s] that it will be watched in one go: meanwhile /tf meets each phase between its cycle and the
  ///                 tick once
  /// @throws std::runtime_error if the node does not serve the whole world within a minute
  RunningNode(const Workload& workload, double watched);

  const std::string& name() const { return name_; }
  /// From now on what is seen of it is added there, until rest().
  void watch(Sightings& sightings);
  void rest();

 private:
  struct Clocks {
    double now = 0.0, node = 0.0, bench = 0.0, all = 0.0;  // [s] the last three of processor
    std::size_t late_cycles = 0;
  };
  Clocks clocks() const;

  const Workload& workload_;
  std::string name_;
  std::unique_ptr<Listener> listener_;
  std::unique_ptr<TfPublisher> publisher_;
  std::unique_ptr<test::ChildProcess> process_;
  Sightings* sightings_ = nullptr;
  Clocks began_;
};

}  // namespace bench
}  // namespace hgrid
