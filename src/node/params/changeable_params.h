// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "node/params/params.h"

namespace hgrid {

/// The value of a parameter that may change while the node runs.
using ChangeableValue = std::variant<bool, int, double>;

/// New values by the names of parameters, such as "distances/max".
using ParamChange = std::map<std::string, ChangeableValue>;

/// A parameter that may change while the node runs.
struct ChangeableParam {
  std::string name;
  std::string meaning;  ///< the meaning, with the unit in brackets in front if there is one
  ChangeableValue value, low, high;
};

/// Returns the parameters that may change while the node runs, with their values in `params`, in the order of the table
/// of parameters.
std::vector<ChangeableParam> changeableParams(const Params& params);

}  // namespace hgrid
