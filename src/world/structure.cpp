// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/structure.h"

#include <algorithm>

namespace hgrid {

std::uint32_t Structure::find(const std::string& name) const {
  const auto found = std::lower_bound(bodies.begin(), bodies.end(), name,
                                      [](const Body& body, const std::string& wanted) { return body.name < wanted; });
  const bool here = found != bodies.end() && found->name == name;
  return here ? static_cast<std::uint32_t>(found - bodies.begin()) : kNone;
}

}  // namespace hgrid
