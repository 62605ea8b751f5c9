// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <nodelet/nodelet.h>

#include <exception>
#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "node/process/proximity_node.h"

namespace hgrid_proximity {

/// Runs the node in a nodelet manager, with the same parameters, topics and services. The node uses its own threads.
class ProximityNodelet : public nodelet::Nodelet {
  void onInit() override {
    try {
      node_ = std::make_unique<hgrid::ProximityNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;
    }
  }

  std::unique_ptr<hgrid::ProximityNode> node_;
};

}  // namespace hgrid_proximity

PLUGINLIB_EXPORT_CLASS(hgrid_proximity::ProximityNodelet, nodelet::Nodelet)
