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

/// A node in a child process. A workload moves the world of the node.
class RunningNode {
 public:
  /// Starts the node and waits until its cache of transforms is full, because a full cache makes the node slower.
  /// @param watched  [s] time between watch() and rest(). The period of /tf is chosen for this time: the offset
  ///   between /tf and the ticks takes each value once.
  /// @throws std::runtime_error if the node does not know the whole world within a minute
  RunningNode(const Workload& workload, double watched);

  const std::string& name() const { return name_; }
  test::ChildProcess& process() const { return *process_; }
  /// Returns the processor time that the node has used since it started [s].
  double processorTime() const;
  /// Adds all measured data to `sightings` from now on, until rest() is called.
  void watch(Sightings& sightings);
  /// Ends what watch() began: adds no more data.
  void rest();

 private:
  struct Clocks {
    double now = 0.0, node = 0.0, bench = 0.0, all = 0.0;  // [s] `now` is a clock time, the others are processor times
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
