// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "node/params/params.h"
#include "node/publishers/structure_watch.h"

namespace hgrid {

/// Publishes ~rules (latched) at the first tick and whenever the structure of the world changes. A rule that begins or
/// ends changes the structure, too. Only the tick thread may use it.
class RulesPublisher {
 public:
  RulesPublisher(ros::NodeHandle& private_node, const Params& params);

  void publish(const Tick& tick);

 private:
  const Params& params_;
  ros::Publisher publisher_;
  StructureWatch watch_;
};

}  // namespace hgrid
