// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/wire/octomap_message.h"

#include "node/wire/wire_walk.h"

namespace hgrid {

OctomapMessage readOctomapMessage(const std::uint8_t* bytes, std::size_t size) {
  WireWalk walk(bytes, size);
  OctomapMessage message;
  walk.number<std::uint32_t>("seq");
  message.stamp.sec = walk.number<std::uint32_t>("stamp");
  message.stamp.nsec = walk.number<std::uint32_t>("stamp");
  message.frame = walk.string("frame_id");
  message.binary = walk.number<std::uint8_t>("binary") != 0;
  message.id = walk.string("id");
  message.resolution = walk.number<double>("resolution");
  message.data = walk.string("data");
  message.flaw = walk.flaw();
  return message;
}

}  // namespace hgrid
