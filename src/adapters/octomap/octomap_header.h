// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "hgrid_proximity/adapters/octomap.h"

namespace hgrid {

/// The header of a `.bt` or `.ot` file.
struct OctomapHeader {
  OctomapFormat format;         ///< id and resolution as in the file; readOctomapData() checks them
  std::uint64_t nodes = 0;      ///< number of nodes that the header claims; not verified
  std::size_t data_offset = 0;  ///< [bytes] where the nodes begin in the file
};

/// Reads the header of a `.bt` or `.ot` file.
/// @throws Refusal truncated if the file ends within the header
/// @throws Refusal parse if the header is not valid
/// @throws Refusal unsupported for the binary header of OctoMap before 1.0
/// @throws Refusal limit if a line has more than 1024 bytes
OctomapHeader readOctomapHeader(std::string_view file, const std::string& what);

}  // namespace hgrid
