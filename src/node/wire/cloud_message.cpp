// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/wire/cloud_message.h"

#include "node/wire/wire_walk.h"

namespace hgrid {

CloudMessage readCloudMessage(const std::uint8_t* bytes, std::size_t size) {
  constexpr std::size_t kLeastField = 13;  // [bytes] an empty name (4), offset (4), datatype (1) and count (4)
  WireWalk walk(bytes, size);
  CloudMessage message;
  PointCloudFormat& format = message.format;
  walk.number<std::uint32_t>("seq");
  message.stamp.sec = walk.number<std::uint32_t>("stamp");
  message.stamp.nsec = walk.number<std::uint32_t>("stamp");
  message.frame = walk.string("frame_id");
  format.height = walk.number<std::uint32_t>("height");
  format.width = walk.number<std::uint32_t>("width");
  for (std::uint32_t left = walk.count("fields", kLeastField); left > 0 && walk.fits(); --left) {
    PointField field;
    field.name = walk.string("field's name");
    field.offset = walk.number<std::uint32_t>("field's offset");
    field.datatype = walk.number<std::uint8_t>("field's datatype");
    walk.number<std::uint32_t>("field's count");
    format.fields.push_back(std::move(field));
  }
  format.big_endian = walk.number<std::uint8_t>("is_bigendian") != 0;
  format.point_step = walk.number<std::uint32_t>("point_step");
  format.row_step = walk.number<std::uint32_t>("row_step");
  message.data = walk.string("data");
  walk.number<std::uint8_t>("is_dense");
  message.flaw = walk.flaw();
  return message;
}

}  // namespace hgrid
