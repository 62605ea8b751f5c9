// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/maps/cloud_stream.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include "bench/measure/turns.h"
#include "hgrid_proximity/adapters/point_cloud.h"
#include "hgrid_proximity/maps/cloud_cells.h"
#include "hgrid_proximity/maps/static_grid.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::uint32_t kWidth = 640, kHeight = 480, kStep = 16;  // pixels of an image; kStep: size of a point [byte]
constexpr int kFrames = 90;
constexpr double kRate = 30.0;  // [Hz] rate of the messages

PointCloudFormat format() {
  PointCloudFormat format;
  format.height = kHeight;
  format.width = kWidth;
  format.point_step = kStep;
  format.row_step = kStep * kWidth;
  format.fields = {{"x", 0, PointField::kFloat32}, {"y", 4, PointField::kFloat32}, {"z", 8, PointField::kFloat32}};
  return format;
}

/// Returns the points of the message at time `time` [s]. A tenth of the points are NaN, like pixels without a depth.
std::string frameAt(double time) {
  std::string data(std::size_t{kWidth} * kHeight * kStep, '\0');
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    for (std::uint32_t column = 0; column < kWidth; ++column) {
      const double yaw = 0.6 * (column / (0.5 * kWidth) - 1.0), pitch = 0.45 * (row / (0.5 * kHeight) - 1.0);
      const double depth = 3.0 + std::sin(3.0 * yaw) * std::cos(4.0 * pitch);
      const bool nothing = (row * 7 + column) % 100 < 10;
      const float point[3] = {nothing ? NAN : static_cast<float>(depth),
                              static_cast<float>(depth * std::tan(yaw) + 0.1 * time),
                              static_cast<float>(depth * std::tan(pitch))};
      std::memcpy(&data[(std::size_t{row} * kWidth + column) * kStep], point, sizeof(point));
    }
  }
  return data;
}

}  // namespace

void playClouds(std::vector<Record>& records) {
  const PointCloudFormat layout = format();
  std::printf("\nclouds of %u points, %d frames\n", kWidth * kHeight, kFrames);
  for (const double edge : {0.05, 0.02}) {
    CloudCells cells(edge, std::chrono::seconds(1), 20000000);
    std::vector<double> took;  // [ms] processing time of each message
    for (int frame = 0; frame < kFrames; ++frame) {
      const Time stamp(static_cast<std::int64_t>(1e9 * frame / kRate));
      const std::string data = frameAt(frame / kRate);
      const Clock::time_point begin = Clock::now();
      const PointCloud cloud = readPointCloud(layout, data, 0.0, "the cloud");
      std::size_t left_out = 0;
      cells.see(cells.cellsOf(cloud.points, Eigen::Vector3d::Zero(), left_out), stamp);
      cells.forget(stamp);
      const StaticGrid grid(edge, cells.cells());
      took.push_back(msSince(begin));
    }
    std::sort(took.begin(), took.end());
    const double median = took[took.size() / 2], p99 = took[took.size() * 99 / 100];
    std::printf("  %-28s %-12s %10.3f ms  p99 %8.3f ms  %zu cells\n", "hgrid",
                (std::to_string(edge).substr(0, 4) + " m").c_str(), median, p99, cells.size());
    Record record("cloud");
    record.text("peer", "hgrid").number("points", kWidth * kHeight).number("edge", edge);
    record.number("cells", double(cells.size())).number("median_ms", median).number("p99_ms", p99);
    records.push_back(record);
  }
  std::fflush(stdout);
}

}  // namespace bench
}  // namespace hgrid
