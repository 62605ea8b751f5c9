// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace hgrid {

/// Numbers the tf frames and knows the parent of each.
///
/// A frame gets a number when its name first occurs, and keeps it. Numbers begin at 0 and have no gaps. A call that
/// throws has changed nothing.
class FrameTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;
  /// The most frames from one to an ancestor of it. A loop of parents ends there.
  static constexpr std::size_t kLongestChain = 1000;

  /// @param max_frames  the most frames that have a parent, and the most that are one (~max_frames)
  explicit FrameTable(std::size_t max_frames) : max_frames_(max_frames) {}

  /// Number of the frame `child`, which a transform places in `parent`. A new child gets a number.
  /// @throws Refusal limit if one more child or parent would be too many
  std::uint32_t admit(const std::string& parent, const std::string& child);
  /// Number of the frame `name`. A new one gets a number.
  std::uint32_t numberOf(const std::string& name);
  /// Sets the parent of a frame. A new parent gets a number. Does not throw if the parent has a number.
  void setParent(std::uint32_t frame, const std::string& parent);

  /// Number of a frame whose name occurred, or kNone.
  std::uint32_t find(const std::string& name) const;
  /// How many frames have a number.
  std::size_t size() const { return entries_.size(); }
  /// How many frames were placed in a parent.
  std::size_t placed() const { return placed_; }
  bool isPlaced(std::uint32_t frame) const { return entries_[frame].placed; }
  const std::string& name(std::uint32_t frame) const { return entries_[frame].name; }
  /// Number of the frame's newest parent, or kNone.
  std::uint32_t parent(std::uint32_t frame) const { return entries_[frame].parent; }
  /// Name of the frame's newest parent; empty: it has none.
  const std::string& parentName(std::uint32_t frame) const;
  bool isInParent(std::uint32_t frame, const std::string& parent) const;
  /// A number that is larger whenever a frame is new or has another parent.
  std::uint64_t revision() const { return revision_; }

 private:
  struct Entry {
    std::string name;
    std::uint32_t parent = kNone;
    std::uint32_t next = kNone;  // the frame that came after it in a message
    bool placed = false;         // a transform placed it in a parent
    bool is_parent = false;
  };

  std::uint32_t add(const std::string& name);
  std::uint32_t guess(const std::string& child) const;
  void checkRoom(const std::string& parent, std::uint32_t number, const std::string& child) const;

  std::size_t max_frames_;
  std::vector<Entry> entries_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
  std::size_t placed_ = 0, parents_ = 0;
  std::uint64_t revision_ = 0;
  std::uint32_t last_ = kNone;  // the frame that was admitted last
};

}  // namespace hgrid
