// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

#include <cstdint>

#include "node/params/changeable_params.h"
#include "node/params/params.h"

namespace hgrid {

/// All parameters of the node, and a hash of them.
struct Settings {
  Params params;
  std::uint64_t config_hash = 0;  ///< equal for equal parameters; sent as WorldState.config_hash
  XmlRpc::XmlRpcValue values;     ///< the same parameters as the parameter server has them, as one struct
};

/// Reads the parameters in the namespace of `private_node`.
/// @throws std::invalid_argument with a message that lists every wrong parameter
Settings readSettings(const ros::NodeHandle& private_node);

/// Returns the values of `change` that differ from those of `settings`. An integer for a parameter that is a number
/// becomes a number.
/// @throws Refusal unsupported if a parameter cannot change while the node runs
ParamChange differencesOf(const ParamChange& change, const Settings& settings);

/// Returns settings with other values. All rules for parameters are checked, also those about several parameters. The
/// hash is the one that a node would have if it was started with these values.
/// @param change  parameters that may change while the node runs, see differencesOf()
/// @throws Refusal out_of_range if the node would not start with these values. The sentence is about one rule, and says
/// how many others are broken.
Settings changedSettings(const Settings& settings, const ParamChange& change);

}  // namespace hgrid
