// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/structure.h"

namespace hgrid {

std::uint32_t Structure::countBefore(const std::string& name) const {
  std::uint32_t begin = 0, end = static_cast<std::uint32_t>(bodies.size());
  while (begin < end) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    if (bodies[middle].name < name) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

std::uint32_t Structure::find(const std::string& name) const {
  const std::uint32_t body = countBefore(name);
  return body < bodies.size() && bodies[body].name == name ? body : kNone;
}

}  // namespace hgrid
