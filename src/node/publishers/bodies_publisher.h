// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "node/publishers/structure_watch.h"

namespace hgrid {

/// Publishes ~bodies (latched) at the first tick and whenever the structure of the world changes.
/// Only the tick thread may use it.
class BodiesPublisher {
 public:
  explicit BodiesPublisher(ros::NodeHandle& private_node);

  void publish(const Tick& tick);

 private:
  ros::Publisher publisher_;
  StructureWatch watch_;
};

}  // namespace hgrid
