// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hgrid {

/// One field of the points in a sensor_msgs/PointCloud2, as sensor_msgs/PointField describes it.
struct PointField {
  static constexpr std::uint8_t kFloat32 = 7;  ///< FLOAT32 of sensor_msgs/PointField
  static constexpr std::uint8_t kFloat64 = 8;  ///< FLOAT64 of sensor_msgs/PointField

  std::string name;           ///< name of the field; only x, y and z are read
  std::uint32_t offset = 0;   ///< [bytes] from the begin of a point to the field
  std::uint8_t datatype = 0;  ///< a constant of sensor_msgs/PointField
};

/// Layout of the bytes of a sensor_msgs/PointCloud2: `height` rows of `width` points.
struct PointCloudFormat {
  std::uint32_t height = 0;        ///< number of rows
  std::uint32_t width = 0;         ///< number of points in a row
  std::vector<PointField> fields;  ///< the fields of each point
  bool big_endian = false;         ///< whether numbers are big-endian; only little-endian numbers can be read
  std::uint32_t point_step = 0;    ///< [bytes] size of a point
  std::uint32_t row_step = 0;      ///< [bytes] size of a row
};

/// The points of a cloud, in the frame of its sensor [m].
struct PointCloud {
  std::vector<Eigen::Vector3d> points;  ///< [m, sensor frame] what the sensor saw, in the order of the data
  std::uint64_t not_finite = 0;         ///< number of other points without a position, where the sensor saw nothing
  std::uint64_t too_near = 0;           ///< number of points with -inf and no +inf: something is too near to be seen
  std::uint64_t no_return = 0;          ///< number of points nearer to the origin than `min_range`
  bool without_row_step = false;        ///< whether the only row has a row_step of 0, and its points fit
};

/// Reads the fields x, y and z of all points and ignores other fields. Any thread may call this.
///
/// REP-117 decides what a point without a finite position says. A driver may also report a beam without return as a
/// point at the origin of the sensor.
/// @param min_range  [m] points nearer to the origin of the frame than this are no points
/// @param what  name of the cloud for the error sentence, such as "cloud 'front'"
/// @throws Refusal with one of these codes:
/// - unsupported: numbers are big-endian, or there is no x, y or z of type FLOAT32 or FLOAT64
/// - parse: there are two fields of one name, or a field, the points or the rows do not have the size of the format
/// - truncated: there are too few bytes for the rows
PointCloud readPointCloud(const PointCloudFormat& format, std::string_view data, double min_range,
                          const std::string& what);

/// Returns how many points of a cloud are nearer to the origin of their frame than `range` [m]. Some drivers report a
/// beam without return as a point at the end of the range or farther, for example at 1e10 m.
std::size_t returnsWithin(double range, const PointCloud& cloud);

}  // namespace hgrid
