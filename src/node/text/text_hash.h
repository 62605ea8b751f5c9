// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>

namespace hgrid {

/// Returns the 64-bit hash of a text by the hash function FNV-1a. It is the same in each run of the node.
/// @param before  hash of the text before this one, so that the result is the hash of both together
inline std::uint64_t fnv1a(const std::string& text, std::uint64_t before = 0xcbf29ce484222325u) {
  std::uint64_t hash = before;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

}  // namespace hgrid
