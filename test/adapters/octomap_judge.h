// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "hgrid_proximity/adapters/octomap.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// The content of a map as the OctoMap library reads it: the leaves in the order of its iterator, and its size().
struct JudgedMap {
  std::vector<Voxel> occupied, free;
  std::uint64_t nodes = 0;
};

/// Reads the nodes of a map with OctoMap's readData() or readBinaryData(). `data` must be complete.
JudgedMap judged(const OctomapFormat& format, const std::string& data, double occupied_from = 0.5);

/// Reads a `.bt` file with OctoMap's readBinary(). @throws std::runtime_error if OctoMap cannot read the file
JudgedMap judgedBinaryFile(const std::string& file);

/// Returns the time [s] that OctoMap's readBinary() needs for a `.bt` file.
double secondsOfReadBinary(const std::string& file);

/// A map that the OctoMap library created and wrote.
struct WrittenMap {
  OctomapFormat format;
  std::string data;  ///< the nodes, as a message contains them
  std::string file;  ///< the bytes of a file, header included
};

/// Returns a random map with clusters of free and occupied leaves. The log-odds of some leaves are at or next to the
/// limit `occupied_from`. Some maps are pruned, and some contain only maximum-likelihood values.
WrittenMap randomMap(Random& random, const std::string& id, bool binary, double occupied_from = 0.5);

}  // namespace test
}  // namespace hgrid
