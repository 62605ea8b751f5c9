// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

namespace hgrid {

/// Reads the bytes of a serialized message in order. Checks each declared length against the number of remaining bytes.
///
/// The first length that does not fit ends the reading: all later calls return zero or an empty string. No memory is
/// allocated for a declared length before it was checked.
class WireWalk {
 public:
  WireWalk(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size), left_(size) {}

  /// Reads a number. @param what  name of the field, for flaw()
  template <class Number>
  Number number(const char* what) {
    Number value{};
    if (!skip(sizeof(Number), what)) return value;
    std::memcpy(&value, bytes_ - sizeof(Number), sizeof(Number));  // assumes a little-endian machine
    return value;
  }
  /// Reads the length of a string and its characters.
  std::string string(const char* what) {
    const auto length = number<std::uint32_t>(what);
    if (!skip(length, what)) return {};
    return {reinterpret_cast<const char*>(bytes_) - length, length};
  }
  /// Skips the length of a string and its characters.
  void skipString(const char* what) { skip(number<std::uint32_t>(what), what); }
  /// Reads the number of elements of a list. @param least_bytes  the smallest possible size of an element
  /// @returns the number of elements; 0 if the remaining bytes cannot hold that many
  std::uint32_t count(const char* what, std::size_t least_bytes) {
    const auto count = number<std::uint32_t>(what);
    least_bytes = std::max<std::size_t>(least_bytes, 1);
    if (!fits() || count <= left_ / least_bytes) return count;
    flaw_ = begin() + what + " of " + std::to_string(count) + " elements needs at least " +
            std::to_string(std::uint64_t{count} * least_bytes) + " bytes";
    return 0;
  }
  /// Skips `count` bytes. @returns whether that many bytes were left
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
  /// Whether all lengths read so far fit into the bytes.
  bool fits() const { return flaw_.empty(); }
  /// Returns why the bytes are not a valid message: a length did not fit, or bytes are left over. Empty: the message is
  /// valid. Call this after all fields were read.
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
