// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/point_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "test/support/random.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

template <class Number>
void put(std::string& bytes, std::size_t at, Number number) {
  std::memcpy(&bytes[at], &number, sizeof(number));
}

/// Returns the format that most drivers use: points of 16 bytes, with x, y, z as floats at the bytes 0, 4 and 8.
PointCloudFormat usual(std::uint32_t height, std::uint32_t width) {
  PointCloudFormat format;
  format.height = height;
  format.width = width;
  format.point_step = 16;
  format.row_step = 16 * width;
  format.fields = {{"x", 0, PointField::kFloat32}, {"y", 4, PointField::kFloat32}, {"z", 8, PointField::kFloat32}};
  return format;
}

TEST(PointCloud, IsReadFromAnyLayout) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    PointCloudFormat format;
    format.height = static_cast<std::uint32_t>(random.between(1, 4));
    format.width = static_cast<std::uint32_t>(random.between(1, 20));
    std::uint32_t offset = 0;
    std::vector<PointField> places;
    for (const char* name : {"z", "intensity", "x", "y"}) {
      offset += static_cast<std::uint32_t>(random.below(5));
      const bool wide = random.chance(0.5);
      format.fields.push_back({name, offset, wide ? PointField::kFloat64 : PointField::kFloat32});
      offset += wide ? 8 : 4;
    }
    format.point_step = offset + static_cast<std::uint32_t>(random.below(9));
    format.row_step = format.point_step * format.width + static_cast<std::uint32_t>(random.below(9));
    std::string data(std::size_t{format.row_step} * format.height, '\x7f');
    std::vector<Eigen::Vector3d> expected;
    std::uint64_t not_finite = 0, too_near = 0;
    for (std::uint32_t row = 0; row < format.height; ++row) {
      for (std::uint32_t i = 0; i < format.width; ++i) {
        Eigen::Vector3d point;
        for (int axis = 0; axis < 3; ++axis) point[axis] = static_cast<float>(random.uniform(-100.0, 100.0));
        if (random.chance(0.2)) point[random.below(3)] = random.chance(0.5) ? NAN : -INFINITY;
        const std::size_t begin = std::size_t{row} * format.row_step + std::size_t{i} * format.point_step;
        for (const PointField& field : format.fields) {
          const double value = field.name == "intensity" ? 7.0 : point[field.name[0] - 'x'];
          if (field.datatype == PointField::kFloat64) {
            put(data, begin + field.offset, value);
          } else {
            put(data, begin + field.offset, static_cast<float>(value));
          }
        }
        point.allFinite() ? expected.push_back(point) : void(++(point.hasNaN() ? not_finite : too_near));
      }
    }
    const PointCloud cloud = readPointCloud(format, data, 0.0, "cloud 'c'");
    EXPECT_EQ(cloud.points, expected);
    EXPECT_EQ(cloud.not_finite, not_finite);
    EXPECT_EQ(cloud.too_near, too_near);
  }
}

TEST(PointCloud, WithoutPointsIsEmpty) {
  EXPECT_TRUE(readPointCloud(PointCloudFormat{}, "", 0.0, "cloud 'c'").points.empty());
  EXPECT_TRUE(readPointCloud(usual(1, 0), "", 0.0, "cloud 'c'").points.empty());
}

/// Returns a cloud of one row with these points.
PointCloud cloudOf(const std::vector<Eigen::Vector3f>& points, double min_range, std::uint32_t row_step) {
  PointCloudFormat format = usual(1, static_cast<std::uint32_t>(points.size()));
  format.row_step = row_step;
  std::string data(16 * points.size(), '\0');
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) put(data, 16 * i + 4 * std::size_t(axis), points[i][axis]);
  }
  return readPointCloud(format, data, min_range, "cloud 'c'");
}

TEST(PointCloud, PointsThatSayNothingOrTooNearAreCountedApart) {
  const float nan = NAN, inf = INFINITY;
  const PointCloud cloud = cloudOf({{0, 0, 0},
                                    {0, 0, 2},
                                    {0, -9e-4f, 0},
                                    {0, 0, 1.1e-3f},
                                    {-inf, -inf, -inf},
                                    {nan, -inf, -inf},
                                    {-inf, inf, inf},
                                    {inf, inf, inf},
                                    {nan, nan, nan}},
                                   0.001, 9 * 16);
  EXPECT_EQ(cloud.points.size(), 2u);
  EXPECT_EQ(cloud.no_return, 2u);
  EXPECT_EQ(cloud.too_near, 2u);
  EXPECT_EQ(cloud.not_finite, 3u);
  EXPECT_EQ(cloudOf({{0, 0, 0}}, 0.0, 16).points.size(), 1u) << "with min_range 0, the origin is a point";
}

TEST(PointCloud, PointsAtTheEndOfTheRangeAreNoReturns) {
  const PointCloud cloud =
      cloudOf({{0, 0, 2}, {0, 29.9f, 0}, {18, 24, 0}, {0, -30, 0}, {0, 0, 1e10f}, {1e38f, 0, 0}}, 0.001, 6 * 16);
  EXPECT_EQ(cloud.points.size(), 6u);
  EXPECT_EQ(returnsWithin(30.0, cloud), 2u);
  EXPECT_EQ(returnsWithin(800.0, cloud), 4u);
  EXPECT_EQ(returnsWithin(30.0, PointCloud{}), 0u);
}

TEST(PointCloud, OfOneRowNeedsNoRowStep) {
  const PointCloud cloud = cloudOf({{0, 0, 1}, {0, 0, 2}}, 0.0, 0);
  EXPECT_EQ(cloud.points.size(), 2u);
  EXPECT_TRUE(cloud.without_row_step);
  EXPECT_FALSE(cloudOf({{0, 0, 1}}, 0.0, 16).without_row_step);
  PointCloudFormat format = usual(2, 1);
  format.row_step = 0;
  EXPECT_EQ(refusalOf([&] { readPointCloud(format, std::string(32, '\0'), 0.0, "cloud 'c'"); }), Code::parse);
  format = usual(1, 2);
  format.row_step = 0;
  EXPECT_EQ(refusalOf([&] { readPointCloud(format, std::string(31, '\0'), 0.0, "cloud 'c'"); }), Code::parse);
}

TEST(PointCloud, WithAWrongFormatIsRefusedByName) {
  const std::string data(3 * 16, '\0');
  const auto expect = [&](Code code, const std::string& words, const PointCloudFormat& format,
                          const std::string& bytes) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { readPointCloud(format, bytes, 0.0, "cloud 'c'"); }, &sentence), code) << words;
    EXPECT_NE(sentence.find("cloud 'c' " + words), std::string::npos) << sentence;
  };
  ASSERT_EQ(readPointCloud(usual(1, 3), data, 0.0, "cloud 'c'").points.size(), 3u);
  for (std::size_t cut = 0; cut < data.size(); ++cut) {
    expect(Code::truncated, "has " + std::to_string(cut) + " bytes of points", usual(1, 3), data.substr(0, cut));
  }
  expect(Code::parse, "has 49 bytes of points", usual(1, 3), data + '\0');
  PointCloudFormat format = usual(1, 3);
  format.big_endian = true;
  expect(Code::unsupported, "is big-endian", format, data);
  format = usual(1, 3);
  format.fields.pop_back();
  expect(Code::unsupported, "has no field 'z'", format, data);
  format = usual(1, 3);
  format.fields[1].datatype = 5;  // 5 means INT32
  expect(Code::unsupported, "has a field 'y' of datatype 5", format, data);
  format = usual(1, 3);
  format.fields.push_back(format.fields[0]);
  expect(Code::parse, "has two fields 'x'", format, data);
  format = usual(1, 3);
  format.fields[2].offset = 13;
  expect(Code::parse, "has its field 'z' at byte 13", format, data);
  format.fields[2].offset = 0xffffffff;
  expect(Code::parse, "has its field 'z' at byte 4294967295", format, data);
  format = usual(1, 3);
  format.row_step = 47;
  expect(Code::parse, "has a row_step of 47 bytes", format, data);
  format = usual(0xffffffff, 0xffffffff);  // the product of these sizes does not fit into 64 bits
  format.row_step = 0xffffffff;
  expect(Code::parse, "has a row_step of 4294967295 bytes", format, data);
  format.point_step = 0;
  expect(Code::parse, "has its field 'x' at byte 0 of points of 0 bytes", format, data);
  format = usual(0x10000, 0x1000000);
  format.row_step = 0x10000000;
  expect(Code::truncated, "has 48 bytes of points", format, data);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
