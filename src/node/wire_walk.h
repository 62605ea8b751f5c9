// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

namespace hgrid {

/// Takes numbers and strings from the bytes of a message until something does not fit. Nothing is allocated for what is
/// not there.
class WireWalk {
 public:
  WireWalk(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}

  template <class Number>
  Number number(const char* what) {
    Number value{};
    if (!take(sizeof(Number), what)) return value;
    std::memcpy(&value, bytes_ - sizeof(Number), sizeof(Number));  // little-endian, as all machines that roscpp runs on
    return value;
  }
  std::string string(const char* what) {
    const auto length = number<std::uint32_t>(what);
    if (!take(length, what)) return {};
    return {reinterpret_cast<const char*>(bytes_) - length, length};
  }
  /// How many elements a list has, of which each takes as many bytes at least.
  std::uint32_t count(const char* what, std::size_t least_bytes) {
    const auto count = number<std::uint32_t>(what);
    if (flaw_.empty() && count > left_ / least_bytes) {
      flaw_ = std::string("the message says that it has ") + std::to_string(count) + " " + what + "; " +
              std::to_string(left_) + " bytes are left";
    }
    return flaw_.empty() ? count : 0;
  }
  /// Whether all fitted so far.
  bool fits() const { return flaw_.empty(); }
  /// What did not fit; empty if all did and nothing is left.
  std::string flaw() const {
    if (!flaw_.empty() || left_ == 0) return flaw_;
    return "the message has " + std::to_string(left_) + " bytes after its end; there must be none";
  }

 private:
  bool take(std::size_t count, const char* what) {
    if (!flaw_.empty()) return false;
    if (count > left_) {
      flaw_ = std::string("the message says that its ") + what + " has " + std::to_string(count) + " bytes; " +
              std::to_string(left_) + " are left";
      return false;
    }
    bytes_ += count;
    left_ -= count;
    return true;
  }

  const std::uint8_t* bytes_;
  std::size_t left_;
  std::string flaw_;
};

}  // namespace hgrid
