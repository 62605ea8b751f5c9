// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace hgrid {
namespace test {

/// Reads numbers from the input of a fuzzer, in order. After the end of the input, all numbers are zero.
class ByteSource {
 public:
  explicit ByteSource(std::string_view bytes) : bytes_(bytes) {}

  /// Returns the next 64 bits.
  std::uint64_t operator()() { return next<std::uint64_t>(); }
  template <class Number>
  Number next() {
    Number value{};
    const std::size_t size = std::min(bytes_.size(), sizeof(value));
    std::memcpy(&value, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return value;
  }
  /// Returns a number in 0 .. count - 1.
  std::uint32_t below(std::uint32_t count) { return next<std::uint8_t>() % count; }
  /// Returns the bytes that are left.
  std::string rest() const { return std::string(bytes_); }

 private:
  std::string_view bytes_;
};

}  // namespace test
}  // namespace hgrid
