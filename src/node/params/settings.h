// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <cstdint>

#include "node/params/params.h"

namespace hgrid {

/// The parameters that the node was started with, and a hash of all of them.
struct Settings {
  Params params;
  std::uint64_t config_hash = 0;  ///< equal for equal parameters; sent as WorldState.config_hash
};

/// Reads the parameters in the namespace of `private_node`.
/// @throws std::invalid_argument with a message that lists every wrong parameter
Settings readSettings(const ros::NodeHandle& private_node);

}  // namespace hgrid
