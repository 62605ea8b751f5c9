// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hgrid {

/// One of the values that a point of a sensor_msgs/PointCloud2 has, as sensor_msgs/PointField tells of it.
struct PointField {
  static constexpr std::uint8_t kFloat32 = 7, kFloat64 = 8;

  std::string name;
  std::uint32_t offset = 0;  ///< [bytes] in the point
  std::uint8_t datatype = 0;
};

/// How points stand in the bytes of a sensor_msgs/PointCloud2: `height` rows of `width` points.
struct PointCloudFormat {
  std::uint32_t height = 0, width = 0;
  std::vector<PointField> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;  ///< [bytes] of a point and of a row
};

/// The points of a cloud, in the frame of its sensor [m].
struct PointCloud {
  std::vector<Eigen::Vector3d> points;
  std::uint64_t not_finite = 0;  ///< points left out since a coordinate is NaN or infinite: where nothing was seen
};

/// Reads the fields x, y and z of all points; other fields are passed over. Any thread.
/// @param what  names the cloud in a refusal, as in "cloud 'front'"
/// @throws Refusal unsupported (big-endian numbers, no x, y or z of type FLOAT32 or FLOAT64), parse (fields that do not
/// fit into a point, points that do not fit into a row, bytes after the last row), truncated (fewer bytes than rows)
PointCloud readPointCloud(const PointCloudFormat& format, std::string_view data, const std::string& what);

}  // namespace hgrid
