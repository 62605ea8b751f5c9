// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>

#include <string>
#include <vector>

namespace hgrid {
namespace test {

/// Lists the registrations of a node, such as "publishes /a/b".
/// @param state  third element of the master's answer to getSystemState: all publishers, subscribers and services
inline std::vector<std::string> registrationsOf(const std::string& node, XmlRpc::XmlRpcValue state) {
  std::vector<std::string> found;
  const char* kinds[] = {"publishes ", "subscribes to ", "serves "};
  for (int kind = 0; kind < 3; ++kind) {
    for (int i = 0; i < state[kind].size(); ++i) {
      XmlRpc::XmlRpcValue& nodes = state[kind][i][1];
      for (int k = 0; k < nodes.size(); ++k) {
        if (static_cast<std::string>(nodes[k]) == node) {
          found.push_back(kinds[kind] + static_cast<std::string>(state[kind][i][0]));
        }
      }
    }
  }
  return found;
}

}  // namespace test
}  // namespace hgrid
