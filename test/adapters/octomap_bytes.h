// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace hgrid {
namespace test {

/// A node of a `.bt`, children in order: '.' unknown, 'f' free, 'o' occupied, 'n' a node.
inline std::string btNode(const std::string& children) {
  unsigned word = 0;
  for (std::size_t i = 0; i < children.size(); ++i) {
    word |= static_cast<unsigned>(std::string(".fon").find(children[i])) << 2 * i;
  }
  return {static_cast<char>(word & 0xff), static_cast<char>(word >> 8)};
}

/// A node of an `.ot` of kind OcTree. @param children  bit i: child i is there
inline std::string otNode(float log_odds, unsigned children = 0) {
  std::string bytes(sizeof(log_odds), '\0');
  std::memcpy(&bytes[0], &log_odds, sizeof(log_odds));
  return bytes + static_cast<char>(children);
}

/// A file's header. @param lines  between the first and "data", as in "id OcTree\nsize 1\nres 0.1\n"
inline std::string btHeader(const std::string& lines) { return "# Octomap OcTree binary file\n" + lines + "data\n"; }
inline std::string otHeader(const std::string& lines) { return "# Octomap OcTree file\n" + lines + "data\n"; }
inline std::string usualLines(const std::string& size) { return "id OcTree\nsize " + size + "\nres 0.1\n"; }

}  // namespace test
}  // namespace hgrid
