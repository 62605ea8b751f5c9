// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <memory>

namespace hgrid {

class NarrowPhase;
class NodeParts;

/// The node, as a program, a nodelet or a test runs it. It works on threads of its own until it is destroyed. Who
/// includes this file need not compile the parts of the node.
class ProximityNode {
 public:
  /// @param narrow_phase  measures exact distances; makeCoreNarrowPhase() if null
  /// @throws std::invalid_argument with a message that lists every wrong parameter
  ProximityNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                std::shared_ptr<NarrowPhase> narrow_phase = nullptr);
  ~ProximityNode();

 private:
  std::unique_ptr<NodeParts> parts_;
};

}  // namespace hgrid
