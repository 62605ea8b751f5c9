// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace hgrid {
namespace test {

/// Returns the bytes of a `.bt` node.
/// @param children  eight letters, one per child: '.' unknown, 'f' free, 'o' occupied, 'n' an inner node
inline std::string btNode(const std::string& children) {
  unsigned word = 0;
  for (std::size_t i = 0; i < children.size(); ++i) {
    word |= static_cast<unsigned>(std::string(".fon").find(children[i])) << 2 * i;
  }
  return {static_cast<char>(word & 0xff), static_cast<char>(word >> 8)};
}

/// Returns the bytes of an `.ot` node of an OcTree. @param children  bit i is set if child i exists
inline std::string otNode(float log_odds, unsigned children = 0) {
  std::string bytes(sizeof(log_odds), '\0');
  std::memcpy(&bytes[0], &log_odds, sizeof(log_odds));
  return bytes + static_cast<char>(children);
}

/// Returns the header of a `.bt` file. @param lines  lines between the first line and "data", such as usualLines("1")
inline std::string btHeader(const std::string& lines) { return "# Octomap OcTree binary file\n" + lines + "data\n"; }
/// Returns the header of an `.ot` file.
inline std::string otHeader(const std::string& lines) { return "# Octomap OcTree file\n" + lines + "data\n"; }
/// Returns the header lines of a valid file. @param size  number of nodes of the map
inline std::string usualLines(const std::string& size) { return "id OcTree\nsize " + size + "\nres 0.1\n"; }

}  // namespace test
}  // namespace hgrid
