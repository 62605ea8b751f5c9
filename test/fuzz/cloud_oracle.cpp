// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/fuzz/cloud_oracle.h"

#include <cmath>
#include <cstring>
#include <map>
#include <stdexcept>

namespace hgrid {
namespace test {
namespace {

/// Reads little-endian numbers and strings. at() throws std::out_of_range at the end of the bytes.
struct Cursor {
  const std::string& bytes;
  std::size_t at = 0;

  std::uint64_t number(int size) {
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i) {
      value |= std::uint64_t{static_cast<unsigned char>(bytes.at(at++))} << (8 * i);
    }
    return value;
  }
  std::string string() {
    std::string text;
    for (std::uint64_t left = number(4); left > 0; --left) text += bytes.at(at++);
    return text;
  }
};

struct Field {
  std::uint64_t offset, datatype;
};

/// Reads a number of a point. Its datatype is 7 (FLOAT32) or 8 (FLOAT64).
double decoded(const std::string& data, std::uint64_t at, const Field& field) {
  Cursor cursor{data, static_cast<std::size_t>(at + field.offset)};
  if (field.datatype == 8) {
    const std::uint64_t bits = cursor.number(8);
    double value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  const auto bits = static_cast<std::uint32_t>(cursor.number(4));
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return static_cast<double>(value);
}

std::optional<PointCloud> decodedOrThrow(const std::string& message) {
  Cursor cursor{message};
  cursor.number(4), cursor.number(4), cursor.number(4);  // seq and stamp
  cursor.string();                                       // frame_id
  const std::uint64_t height = cursor.number(4), width = cursor.number(4);
  std::multimap<std::string, Field> fields;
  for (std::uint64_t left = cursor.number(4); left > 0; --left) {
    const std::string name = cursor.string();
    const std::uint64_t offset = cursor.number(4), datatype = cursor.number(1);
    cursor.number(4);  // count
    fields.emplace(name, Field{offset, datatype});
  }
  const bool big_endian = cursor.number(1) != 0;
  const std::uint64_t point_step = cursor.number(4);
  std::uint64_t row_step = cursor.number(4);
  const std::string data = cursor.string();
  cursor.number(1);  // is_dense
  if (cursor.at != message.size()) return std::nullopt;

  PointCloud cloud;
  if ((height == 0 || width == 0) && data.empty()) return cloud;
  if (row_step == 0 && height == 1) row_step = width * point_step;  // the step leads nowhere
  if (big_endian || width * point_step > row_step || data.size() != height * row_step) return std::nullopt;
  for (const char* name : {"x", "y", "z"}) {
    if (fields.count(name) != 1) return std::nullopt;
    const Field& field = fields.find(name)->second;
    if (field.datatype != 7 && field.datatype != 8) return std::nullopt;
    if (field.offset + (field.datatype == 8 ? 8 : 4) > point_step) return std::nullopt;
  }
  for (std::uint64_t row = 0; width > 0 && row < height; ++row) {
    for (std::uint64_t i = 0; i < width; ++i) {
      const std::uint64_t at = row * row_step + i * point_step;
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = decoded(data, at, fields.find(std::string(1, "xyz"[axis]))->second);
      }
      const bool finite = std::isfinite(point.x()) && std::isfinite(point.y()) && std::isfinite(point.z());
      const bool too_near = (point.array() == -INFINITY).any() && !(point.array() == INFINITY).any();
      if (finite) cloud.points.push_back(point);
      if (!finite) ++(too_near ? cloud.too_near : cloud.not_finite);
    }
  }
  return cloud;
}

}  // namespace

std::optional<PointCloud> slowlyDecoded(const std::string& message) {
  try {
    return decodedOrThrow(message);
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

}  // namespace test
}  // namespace hgrid
