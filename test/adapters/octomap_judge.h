// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/adapters/octomap.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// What OctoMap itself makes of a map: the leaves that its own iterator meets, in its order, and its size().
struct JudgedMap {
  std::vector<Voxel> occupied, free;
  std::uint64_t nodes = 0;
};

/// As OctoMap's readData() and readBinaryData() read; what is read must be whole.
JudgedMap judged(const OctomapFormat& format, const std::string& data, double occupied_from = 0.5);

/// As OctoMap's readBinary() reads a whole `.bt`. @throws std::runtime_error if it does not
JudgedMap judgedBinaryFile(const std::string& file);

/// Seconds that readBinary() takes for a whole `.bt`.
double secondsOfReadBinary(const std::string& file);

/// A map that OctoMap made and wrote.
struct WrittenMap {
  OctomapFormat format;
  std::string data;  ///< as in a message
  std::string file;  ///< as in a file
};

/// Clusters of free and occupied leaves, some of log-odds at or next to those of `occupied_from`; pruned or not, made
/// of likeliest values or not.
WrittenMap randomMap(Random& random, const std::string& id, bool binary, double occupied_from = 0.5);

}  // namespace test
}  // namespace hgrid
