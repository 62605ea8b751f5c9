// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace hgrid {

/// Reads the bytes of a serialized message from front to back and checks every length against the bytes that are left.
///
/// The first length that does not fit ends the walk: all later reads return zero or an empty string. Nothing is
/// allocated for a declared length before the check.
class WireWalk {
 public:
  WireWalk(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size), left_(size) {}

  /// Reads a number. @param what  the field's name for flaw()
  template <class Number>
  Number number(const char* what) {
    Number value{};
    if (!skip(sizeof(Number), what)) return value;
    std::memcpy(&value, bytes_ - sizeof(Number), sizeof(Number));  // little-endian, as all machines that roscpp runs on
    return value;
  }
  /// Reads the length of a string and its characters.
  std::string string(const char* what) {
    const auto length = number<std::uint32_t>(what);
    if (!skip(length, what)) return {};
    return {reinterpret_cast<const char*>(bytes_) - length, length};
  }
  /// Passes the length of a string and its characters.
  void skipString(const char* what) { skip(number<std::uint32_t>(what), what); }
  /// Reads the number of elements of a list. @param least_bytes  that an element takes at least
  /// @returns 0 if the bytes that are left cannot hold so many elements
  std::uint32_t count(const char* what, std::size_t least_bytes) {
    const auto count = number<std::uint32_t>(what);
    least_bytes = std::max<std::size_t>(least_bytes, 1);
    if (!fits() || count <= left_ / least_bytes) return count;
    flaw_ = begin() + what + " of " + std::to_string(count) + " elements needs at least " +
            std::to_string(std::uint64_t{count} * least_bytes) + " bytes";
    return 0;
  }
  /// Passes `count` bytes. @returns whether so many were left
  bool skip(std::size_t count, const char* what) {
    if (!fits()) return false;
    if (count > left_) {
      flaw_ = begin() + what + " needs " + std::to_string(count) + " bytes";
      return false;
    }
    bytes_ += count;
    left_ -= count;
    return true;
  }
  /// Whether all lengths so far fitted.
  bool fits() const { return flaw_.empty(); }
  /// Why the bytes are not those of a message: the first length that did not fit, or bytes that are left over. Empty if
  /// the message ends where the bytes end.
  std::string flaw() const {
    if (!fits() || left_ == 0) return flaw_;
    return sizeSentence() + "it must end at byte " + std::to_string(size_ - left_);
  }

 private:
  std::string sizeSentence() const { return "the message is " + std::to_string(size_) + " bytes long; "; }
  std::string begin() const { return sizeSentence() + "from byte " + std::to_string(size_ - left_) + " on, "; }

  const std::uint8_t* bytes_;
  std::size_t size_, left_;
  std::string flaw_;
};

}  // namespace hgrid
