// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "hgrid_proximity/adapters/octomap.h"

namespace hgrid {

/// What stands before the nodes of a `.bt` or `.ot` file.
struct OctomapHeader {
  OctomapFormat format;         ///< id and resolution as written; readOctomapData() checks them
  std::uint64_t nodes = 0;      ///< as the header claims: only good for a comparison
  std::size_t data_offset = 0;  ///< where the nodes begin
};

/// @throws Refusal truncated, parse, unsupported (another kind of file), limit (a line of more than 1024 bytes)
OctomapHeader readOctomapHeader(std::string_view file, const std::string& what);

}  // namespace hgrid
