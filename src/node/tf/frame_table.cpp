// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_table.h"

#include "hgrid_proximity/refusal.h"

namespace hgrid {

std::uint32_t FrameTable::find(const std::string& name) const {
  const auto found = numbers_.find(name);
  return found == numbers_.end() ? kNone : found->second;
}

/// Returns the same as find(), but usually faster. Messages repeat the same frames in the same order. So this function
/// first tries the frame that came next the last time.
std::uint32_t FrameTable::guess(const std::string& child) const {
  const std::uint32_t next = last_ == kNone ? kNone : entries_[last_].next;
  return next != kNone && entries_[next].name == child ? next : find(child);
}

std::uint32_t FrameTable::add(const std::string& name) {
  const auto number = static_cast<std::uint32_t>(entries_.size());
  Entry entry;
  entry.name = name;
  if (entries_.size() == entries_.capacity()) entries_.reserve(2 * entries_.size() + 8);
  numbers_.emplace(name, number);
  entries_.push_back(std::move(entry));  // does not throw, because the capacity was reserved above
  ++revision_;
  return number;
}

void FrameTable::checkRoom(const std::string& parent, std::uint32_t number, const std::string& child) const {
  const std::uint32_t known_parent = find(parent);
  const bool new_child = number == kNone || !entries_[number].placed;
  const bool new_parent = known_parent == kNone || !entries_[known_parent].is_parent;
  if ((new_child && placed_ >= max_frames_) || (new_parent && parents_ >= max_frames_)) {
    throw Refusal(Code::limit, "transform of frame '" + printable(child) +
                                   "' would add one frame too many; ~max_frames is " + std::to_string(max_frames_));
  }
}

std::uint32_t FrameTable::admit(const std::string& parent, const std::string& child) {
  std::uint32_t number = guess(child);
  if (number == kNone || !isInParent(number, parent)) {
    checkRoom(parent, number, child);
    if (number == kNone) number = add(child);
    if (!entries_[number].placed) {
      entries_[number].placed = true;
      ++placed_;
      ++revision_;
    }
  }
  if (last_ != kNone) entries_[last_].next = number;
  return last_ = number;
}

std::uint32_t FrameTable::numberOf(const std::string& name) {
  const std::uint32_t number = find(name);
  return number == kNone ? add(name) : number;
}

void FrameTable::setParent(std::uint32_t frame, const std::string& parent) {
  if (isInParent(frame, parent)) return;
  const std::uint32_t number = numberOf(parent);
  if (!entries_[number].is_parent) {
    entries_[number].is_parent = true;
    ++parents_;
  }
  entries_[frame].parent = number;
  ++revision_;
}

const std::string& FrameTable::parentName(std::uint32_t frame) const {
  static const std::string none;
  const std::uint32_t parent = entries_[frame].parent;
  return parent == kNone ? none : entries_[parent].name;
}

bool FrameTable::isInParent(std::uint32_t frame, const std::string& parent) const {
  const std::uint32_t number = entries_[frame].parent;
  return number != kNone && entries_[number].name == parent;
}

}  // namespace hgrid
