// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "src/node/params/settings.h"

namespace hgrid {
namespace test {

/// Returns settings with these parameters, with the hash 0.
inline std::shared_ptr<const Settings> settingsOf(const Params& params) {
  Settings settings;
  settings.params = params;
  settings.values.begin();  // turns the value into an empty struct
  return std::make_shared<const Settings>(settings);
}

}  // namespace test
}  // namespace hgrid
