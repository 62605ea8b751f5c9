// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "octomap_message.h"

#include <cstring>

namespace hgrid {
namespace {

/// Takes numbers and strings from bytes until something does not fit.
class Walk {
 public:
  Walk(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}

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

}  // namespace

OctomapMessage readOctomapMessage(const std::uint8_t* bytes, std::size_t size) {
  Walk walk(bytes, size);
  OctomapMessage message;
  walk.number<std::uint32_t>("seq");
  message.stamp.sec = walk.number<std::uint32_t>("stamp");
  message.stamp.nsec = walk.number<std::uint32_t>("stamp");
  message.frame = walk.string("frame_id");
  message.binary = walk.number<std::uint8_t>("binary") != 0;
  message.id = walk.string("id");
  message.resolution = walk.number<double>("resolution");
  message.data = walk.string("data");
  message.flaw = walk.flaw();
  return message;
}

}  // namespace hgrid
