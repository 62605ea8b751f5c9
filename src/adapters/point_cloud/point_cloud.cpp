// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/point_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

/// Where a coordinate is in the bytes of a point, and its type.
struct FieldPlace {
  std::uint32_t offset = 0;  // [bytes] from the begin of the point
  bool wide = false;         // true: FLOAT64; false: FLOAT32

  double read(const char* point) const {
    if (wide) return number<double>(point + offset);
    return static_cast<double>(number<float>(point + offset));
  }

 private:
  template <class Number>
  static Number number(const char* bytes) {
    Number value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
  }
};

FieldPlace placeOf(const char* name, const PointCloudFormat& format, const std::string& what) {
  const PointField* found = nullptr;
  for (const PointField& field : format.fields) {
    if (field.name != name) continue;
    if (found != nullptr) throw Refusal(Code::parse, what + " has two fields '" + name + "'; it must have one");
    found = &field;
  }
  if (found == nullptr || (found->datatype != PointField::kFloat32 && found->datatype != PointField::kFloat64)) {
    throw Refusal(Code::unsupported, what +
                                         (found == nullptr ? " has no field '" + std::string(name) + "'"
                                                           : " has a field '" + std::string(name) + "' of datatype " +
                                                                 std::to_string(found->datatype)) +
                                         "; it must have x, y and z as FLOAT32 (7) or FLOAT64 (8)");
  }
  const bool wide = found->datatype == PointField::kFloat64;
  if (std::uint64_t{found->offset} + (wide ? 8 : 4) > format.point_step) {
    throw Refusal(Code::parse, what + " has its field '" + name + "' at byte " + std::to_string(found->offset) +
                                   " of points of " + std::to_string(format.point_step) +
                                   " bytes; the field must fit into a point");
  }
  return {found->offset, wide};
}

/// Counts a point without a finite position. As REP-117 has it, a range of -inf is an object that is too near. A driver
/// may write it into all coordinates, or multiply it with the direction of the beam, which also makes NaN. A range of
/// +inf in a direction with negative coordinates alone looks alike, and then counts as too near.
void countNotFinite(const Eigen::Vector3d& point, PointCloud& cloud) {
  bool below = false, above = false;
  for (int axis = 0; axis < 3; ++axis) {
    below = below || (std::isinf(point[axis]) && point[axis] < 0.0);
    above = above || (std::isinf(point[axis]) && point[axis] > 0.0);
  }
  ++(below && !above ? cloud.too_near : cloud.not_finite);
}

void checkSizes(const PointCloudFormat& format, std::string_view data, const std::string& what) {
  if (std::uint64_t{format.width} * format.point_step > format.row_step) {
    throw Refusal(Code::parse, what + " has a row_step of " + std::to_string(format.row_step) +
                                   " bytes; each row must hold " + std::to_string(format.width) + " points of " +
                                   std::to_string(format.point_step) + " bytes");
  }
  const std::uint64_t bytes = std::uint64_t{format.height} * format.row_step;
  if (data.size() == bytes) return;
  throw Refusal(data.size() < bytes ? Code::truncated : Code::parse,
                what + " has " + std::to_string(data.size()) + " bytes of points; " + std::to_string(format.height) +
                    " rows of " + std::to_string(format.row_step) + " bytes are expected");
}

}  // namespace

PointCloud readPointCloud(const PointCloudFormat& given, std::string_view data, double min_range,
                          const std::string& what) {
  PointCloud cloud;
  PointCloudFormat format = given;
  if (format.row_step == 0 && format.height == 1 && data.size() == std::uint64_t{format.width} * format.point_step) {
    format.row_step = static_cast<std::uint32_t>(data.size());  // the step leads nowhere, because there is no other row
    cloud.without_row_step = format.row_step > 0;
  }
  const std::uint64_t count = std::uint64_t{format.height} * format.width;
  if (count == 0 && data.empty()) return cloud;
  if (format.big_endian) throw Refusal(Code::unsupported, what + " is big-endian; it must be little-endian");
  const std::array<FieldPlace, 3> places{placeOf("x", format, what), placeOf("y", format, what),
                                         placeOf("z", format, what)};
  checkSizes(format, data, what);
  cloud.points.reserve(count);  // safe: checkSizes() has compared `count` with the size of the data
  for (std::uint32_t row = 0; row < format.height; ++row) {
    const char* point = data.data() + std::size_t{row} * format.row_step;
    for (std::uint32_t i = 0; i < format.width; ++i, point += format.point_step) {
      const Eigen::Vector3d at(places[0].read(point), places[1].read(point), places[2].read(point));
      if (!at.allFinite()) {
        countNotFinite(at, cloud);
      } else if (at.norm() < min_range) {
        ++cloud.no_return;
      } else {
        cloud.points.push_back(at);
      }
    }
  }
  return cloud;
}

std::size_t returnsWithin(double range, const PointCloud& cloud) {
  const double end = (1.0 - 1e-6) * range;  // the rounding of coordinates in floats is smaller
  return static_cast<std::size_t>(std::count_if(cloud.points.begin(), cloud.points.end(),
                                                [end](const Eigen::Vector3d& point) { return point.norm() < end; }));
}

}  // namespace hgrid
