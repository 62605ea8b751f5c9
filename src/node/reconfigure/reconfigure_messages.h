// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include "node/params/changeable_params.h"

namespace hgrid {

/// Returns the description of all parameters that may change: types, defaults and ranges.
dynamic_reconfigure::ConfigDescription descriptionMessage();

/// Returns the values of all parameters that may change.
dynamic_reconfigure::Config configMessage(const Params& params);

/// Returns the values in a message. Their names and ranges are not checked.
/// @throws Refusal dup_id if a parameter occurs twice, limit if there are more values than parameters that may change,
/// or unsupported if a value is a string
ParamChange changeOf(const dynamic_reconfigure::Config& config);

}  // namespace hgrid
