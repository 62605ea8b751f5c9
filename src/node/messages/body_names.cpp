// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/body_names.h"

#include <algorithm>

namespace hgrid {

void nameBodies(const BodyList& bodies, std::initializer_list<std::vector<std::uint32_t>*> lists,
                std::vector<std::string>& names) {
  std::vector<std::uint32_t> used, place(bodies.size(), kNoBody);
  for (const auto* list : lists) {
    for (const std::uint32_t body : *list) {
      if (body == kNoBody || place[body] != kNoBody) continue;
      place[body] = 0;
      used.push_back(body);
    }
  }
  std::sort(used.begin(), used.end(),
            [&](std::uint32_t a, std::uint32_t b) { return bodies[a].name < bodies[b].name; });
  for (std::uint32_t i = 0; i < used.size(); ++i) {
    place[used[i]] = i;
    names.push_back(bodies[used[i]].name);
  }
  for (auto* list : lists) {
    for (std::uint32_t& body : *list) body = body == kNoBody ? kNoBody : place[body];
  }
}

}  // namespace hgrid
