// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/octomap_oracle.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {

FuzzResult fuzzOctomap(std::string_view input) {
  if (input.empty()) return {};
  const auto bits = static_cast<unsigned char>(input[0]);
  input.remove_prefix(1);
  OctomapOptions options;
  options.nan_is_occupied = bits & 1;
  if (bits & 2) options.unknown = bits & 8 ? UnknownSpace::report : UnknownSpace::occupied;
  options.keep_free = bits & 4;
  options.allow_empty = bits & 8;
  if (bits & 16) options.crop = Eigen::AlignedBox3d(Eigen::Vector3d(-1.0, -2.0, 0.0), Eigen::Vector3d(1.0, 2.0, 1.5));
  const bool message = bits & 32, binary = bits & 64, color = bits & 128;
  try {
    const Octomap map = message
                            ? readOctomapData({color ? "ColorOcTree" : "OcTree", binary, 0.1}, input, "map", options)
                            : readOctomap(input, "map", options);
    return {true, flawOf(map, options)};
  } catch (const Refusal& refusal) {
    return {false, flawOfRefusal(refusal)};
  }
}

}  // namespace test
}  // namespace hgrid
