// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

namespace hgrid {

/// What proximity_mesh_reader writes to its standard output, in the machine's byte order: a StreamHeader, then
/// for `mesh` that many vertices (three floats each) and triangles (three uint32 each), for `refusal` that
/// many bytes of a sentence.
struct StreamHeader {
  static constexpr std::uint64_t kMesh = 0x31304853454d4748;     // "HGMESH01"
  static constexpr std::uint64_t kRefusal = 0x31304c4941464748;  // "HGFAIL01"

  std::uint64_t kind = 0;
  std::uint32_t vertices = 0;   // refusal: the Code
  std::uint32_t triangles = 0;  // refusal: bytes of the sentence
};

}  // namespace hgrid
