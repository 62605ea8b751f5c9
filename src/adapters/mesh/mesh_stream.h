// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

namespace hgrid {

/// The header of the output of proximity_mesh_reader. All numbers have the byte order of the machine.
///
/// If `kind` is kMesh, `vertices` vertices (three floats each) and `triangles` triangles (three uint32 each) follow. If
/// `kind` is kRefusal, an error sentence of `triangles` bytes follows.
struct StreamHeader {
  static constexpr std::uint64_t kMesh = 0x31304853454d4748;     // "HGMESH01"
  static constexpr std::uint64_t kRefusal = 0x31304c4941464748;  // "HGFAIL01"

  std::uint64_t kind = 0;
  std::uint32_t vertices = 0;   // number of vertices; if `kind` is kRefusal: the number of the Code
  std::uint32_t triangles = 0;  // number of triangles; if `kind` is kRefusal: [bytes] length of the sentence
};

}  // namespace hgrid
