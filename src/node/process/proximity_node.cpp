// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/proximity_node.h"

#include <utility>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "node/process/node_parts.h"

namespace hgrid {

ProximityNode::ProximityNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                             std::shared_ptr<NarrowPhase> narrow_phase)
    : parts_(std::make_unique<NodeParts>(node, private_node,
                                         narrow_phase ? std::move(narrow_phase) : makeCoreNarrowPhase())) {}

ProximityNode::~ProximityNode() = default;

}  // namespace hgrid
