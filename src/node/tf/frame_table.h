// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace hgrid {

/// Gives each tf frame a number and stores its parent.
///
/// A frame gets a number when its name first occurs, and keeps that number. Numbers begin at 0 and have no gaps. A call
/// that throws changes nothing.
///
/// The frames that bodies need have room of their own. So a flood of other frames cannot keep them out.
class FrameTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;
  /// The largest number of parents that are followed upwards from a frame. This ends the search in a loop of parents.
  static constexpr std::size_t kLongestChain = 1000;

  /// @param max_frames  ~limits/max_frames: at most this many frames may have a parent, and at most this many may be a parent.
  ///                    As many needed frames may have a parent or be a parent, in addition.
  explicit FrameTable(std::size_t max_frames) : max_frames_(max_frames) {}
  FrameTable(const FrameTable&) = delete;
  FrameTable& operator=(const FrameTable&) = delete;

  /// Returns the number of the frame `child`, which a transform places in `parent`. A new child gets a number.
  /// @throws Refusal limit if there is no room for another child or parent
  std::uint32_t admit(std::string_view parent, std::string_view child);
  /// Returns the number of the frame `child` if it is known and its parent is `parent`; otherwise kNone. The names,
  /// numbers and parents of the frames do not change.
  std::uint32_t again(std::string_view parent, std::string_view child);
  /// Returns the number of the frame `name`. A new frame gets a number.
  std::uint32_t numberOf(std::string_view name);
  /// Sets the parent of a frame. A new parent gets a number. Does not throw if the parent has a number.
  void setParent(std::uint32_t frame, std::string_view parent);

  /// Sets which frames bodies need. The parents of a needed frame are needed too, also those that it gets later. Call
  /// this when bodies were added or removed.
  void need(const std::vector<std::string>& names);
  /// Sets the names of the free frames: those that a planar or floating joint moves.
  /// @returns whether this is a change
  bool setFree(std::set<std::string, std::less<>> names);
  bool isFree(std::uint32_t frame) const { return entries_[frame].free; }
  /// Whether bodies need a frame, or a frame below it.
  bool isNeeded(std::string_view name) const { return isNeeded(find(name), name); }

  /// Returns the number of the frame `name`, or kNone if this name has not occurred.
  std::uint32_t find(std::string_view name) const;
  /// Returns how many frames have a number.
  std::size_t size() const { return entries_.size(); }
  /// Returns how many frames a transform has placed in a parent.
  std::size_t placed() const { return placed_.all; }
  bool isPlaced(std::uint32_t frame) const { return entries_[frame].placed; }
  const std::string& name(std::uint32_t frame) const { return *entries_[frame].name; }
  /// Returns the number of the frame's newest parent, or kNone if it has no parent.
  std::uint32_t parent(std::uint32_t frame) const { return entries_[frame].parent; }
  /// Returns the name of the frame's newest parent. Empty: the frame has no parent.
  const std::string& parentName(std::uint32_t frame) const;
  bool isInParent(std::uint32_t frame, std::string_view parent) const;
  /// Returns a number that increases whenever a frame is added or gets another parent.
  std::uint64_t revision() const { return revision_; }

 private:
  /// A frame. It fills one line of the processor's cache, because again() reads it for each received transform.
  struct alignas(64) Entry {
    explicit Entry(const std::string& full_name);
    bool isNamed(std::string_view other) const;

    const std::string* name;  // in numbers_
    std::uint32_t length;     // of the name
    std::uint32_t parent = kNone;
    std::uint32_t next = kNone;  // the frame that admit() or again() returned right after this one
    bool placed = false;         // whether a transform has placed this frame in a parent
    bool is_parent = false;
    bool needed = false;
    bool free = false;
    std::array<char, 40> begin = {};  // first characters of the name; most names fit
  };
  static_assert(sizeof(Entry) == 64);
  /// How many frames there are of a kind.
  struct Count {
    std::size_t all = 0, needed = 0;
    bool isFull(bool for_needed, std::size_t most) const { return (for_needed ? needed : all - needed) >= most; }
    void add(bool of_needed) {
      ++all;
      needed += of_needed ? 1 : 0;
    }
  };

  std::uint32_t add(std::string_view name);
  std::uint32_t guess(std::string_view child) const;
  bool isNeeded(std::uint32_t number, std::string_view name) const;
  void setNeeded(std::uint32_t number);
  std::uint32_t noteLast(std::uint32_t number);
  void checkRoom(std::string_view parent, std::uint32_t number, std::string_view child) const;

  std::size_t max_frames_;
  std::vector<Entry> entries_;
  // Sorted, not hashed, because senders choose the names and could choose names that collide.
  std::map<std::string, std::uint32_t, std::less<>> numbers_;
  Count placed_, parents_;
  std::set<std::string, std::less<>> needed_;  // names that need() received; some of them may have no number yet
  std::set<std::string, std::less<>> free_;    // names of free frames; some of them may have no number yet
  std::uint64_t revision_ = 0;
  std::uint32_t last_ = kNone;  // the frame that admit() or again() returned last
};

}  // namespace hgrid
