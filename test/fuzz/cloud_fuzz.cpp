// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/wire/cloud_message.h"
#include "test/fuzz/byte_source.h"
#include "test/fuzz/cloud_oracle.h"
#include "test/fuzz/targets.h"
#include "test/node/support/raw_message.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

std::string fieldFrom(ByteSource& bytes) {
  static const std::string kNames[] = {"x", "y", "z", "rgb", "X", ""};
  const std::string& name = kNames[bytes.below(6)];
  const std::uint32_t offset = bytes.below(16) == 0 ? bytes.next<std::uint32_t>() : bytes.below(24);
  const char datatype = static_cast<char>(bytes.below(4) == 0 ? bytes.below(256) : 7 + bytes.below(2));
  return stringOf(name) + bytesOf(offset) + datatype + bytesOf(std::uint32_t{bytes.below(3)});
}

/// Returns a message with the layout that the bytes describe. In most of these messages, all sizes are consistent.
std::string describedBy(ByteSource bytes) {
  const std::uint32_t height = bytes.below(4), width = bytes.below(7), count = bytes.below(6);
  std::string fields = bytesOf(count);
  for (std::uint32_t i = 0; i < count; ++i) fields += fieldFrom(bytes);
  const char big_endian = bytes.below(8) == 0 ? 1 : 0;
  const std::uint32_t point_step = bytes.below(32);
  const std::uint32_t row_step = width * point_step + (bytes.below(4) == 0 ? bytes.below(8) : 0);
  std::size_t size = std::size_t{height} * row_step;
  if (bytes.below(8) == 0) size += bytes.below(3);
  std::string data = bytes.rest();
  data.resize(size, '?');
  const auto number = [](std::uint32_t value) { return bytesOf(value); };
  return number(0) + number(1) + number(2) + stringOf("frame") + number(height) + number(width) + fields + big_endian +
         number(point_step) + number(row_step) + stringOf(data) + '\1';
}

/// Compares the cloud that the product read with the reference. @returns how they differ; empty if they are equal
std::string differenceOf(const PointCloud& cloud, const PointCloud& reference) {
  if (cloud.not_finite != reference.not_finite) return "the number of points that are not finite is wrong";
  if (cloud.too_near != reference.too_near) return "the number of points that are too near is wrong";
  return cloud.points == reference.points ? "" : "the points are wrong";
}

}  // namespace

FuzzResult fuzzCloud(std::string_view input) {
  if (input.empty()) return {};
  const bool described = input[0] & 1;
  input.remove_prefix(1);
  const std::string bytes = described ? describedBy(ByteSource(input)) : std::string(input);
  const std::optional<PointCloud> reference = slowlyDecoded(bytes);
  const CloudMessage message = readCloudMessage(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (!message.flaw.empty()) return {false, reference ? "a valid message was refused" : flawOfSentence(message.flaw)};
  try {
    const PointCloud cloud = readPointCloud(message.format, message.data, 0.0, "cloud 'a'");
    return {true, reference ? differenceOf(cloud, *reference) : "an invalid cloud was accepted"};
  } catch (const Refusal& refusal) {
    return {false, reference ? "a valid cloud was refused" : flawOfRefusal(refusal)};
  }
}

}  // namespace test
}  // namespace hgrid
