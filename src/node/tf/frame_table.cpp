// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_table.h"

#include <algorithm>
#include <cstring>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

FrameTable::Entry::Entry(const std::string& full_name)
    : name(&full_name), length(static_cast<std::uint32_t>(full_name.size())) {
  std::copy_n(full_name.begin(), std::min(full_name.size(), begin.size()), begin.begin());
}

bool FrameTable::Entry::isNamed(std::string_view other) const {
  if (other.size() != length || std::memcmp(begin.data(), other.data(), std::min(other.size(), begin.size())) != 0) {
    return false;
  }
  return other.size() <= begin.size() || other == *name;
}

std::uint32_t FrameTable::find(std::string_view name) const {
  const auto found = numbers_.find(name);
  return found == numbers_.end() ? kNone : found->second;
}

/// Returns the same as find(), but usually faster. Messages repeat the same frames in the same order. So this function
/// first tries the frame that came next the last time.
std::uint32_t FrameTable::guess(std::string_view child) const {
  const std::uint32_t next = last_ == kNone ? kNone : entries_[last_].next;
  return next != kNone && entries_[next].isNamed(child) ? next : find(child);
}

std::uint32_t FrameTable::add(std::string_view name) {
  const auto number = static_cast<std::uint32_t>(entries_.size());
  if (entries_.size() == entries_.capacity()) entries_.reserve(2 * entries_.size() + 8);
  const auto place = numbers_.emplace(name, number).first;
  Entry& entry = entries_.emplace_back(place->first);  // does not throw: there is room for it
  entry.needed = needed_.count(name) != 0;
  entry.free = free_.count(name) != 0;
  ++revision_;
  return number;
}

void FrameTable::checkRoom(std::string_view parent, std::uint32_t number, std::string_view child) const {
  const std::uint32_t known_parent = find(parent);
  const bool new_child = number == kNone || !entries_[number].placed;
  const bool new_parent = known_parent == kNone || !entries_[known_parent].is_parent;
  const bool needed = isNeeded(number, child), parent_needed = needed || isNeeded(known_parent, parent);
  if ((new_child && placed_.isFull(needed, max_frames_)) ||
      (new_parent && parents_.isFull(parent_needed, max_frames_))) {
    throw Refusal(Code::limit, "transform of frame '" + printable(std::string(child)) +
                                   "' would add one frame too many; ~limits/max_frames is " + std::to_string(max_frames_));
  }
}

std::uint32_t FrameTable::again(std::string_view parent, std::string_view child) {
  const std::uint32_t number = guess(child);
  return number == kNone || !isInParent(number, parent) ? kNone : noteLast(number);
}

std::uint32_t FrameTable::admit(std::string_view parent, std::string_view child) {
  std::uint32_t number = again(parent, child);
  if (number != kNone) return number;
  number = find(child);
  checkRoom(parent, number, child);
  if (number == kNone) number = add(child);
  if (!entries_[number].placed) {
    entries_[number].placed = true;
    placed_.add(entries_[number].needed);
    ++revision_;
  }
  return noteLast(number);
}

/// Notes which frame was the last one, for guess().
std::uint32_t FrameTable::noteLast(std::uint32_t number) {
  if (last_ != kNone) entries_[last_].next = number;
  return last_ = number;
}

std::uint32_t FrameTable::numberOf(std::string_view name) {
  const std::uint32_t number = find(name);
  return number == kNone ? add(name) : number;
}

void FrameTable::setParent(std::uint32_t frame, std::string_view parent) {
  if (isInParent(frame, parent)) return;
  const std::uint32_t number = numberOf(parent);
  if (!entries_[number].is_parent) {
    entries_[number].is_parent = true;
    parents_.add(entries_[number].needed);
  }
  entries_[frame].parent = number;
  if (entries_[frame].needed) setNeeded(number);
  ++revision_;
}

/// Whether bodies need a frame that may not have a number yet.
bool FrameTable::isNeeded(std::uint32_t number, std::string_view name) const {
  return number == kNone ? needed_.count(name) != 0 : entries_[number].needed;
}

/// Marks a frame and the frames above it as needed.
void FrameTable::setNeeded(std::uint32_t number) {
  for (; number != kNone && !entries_[number].needed; number = entries_[number].parent) {
    Entry& entry = entries_[number];
    entry.needed = true;
    placed_.needed += entry.placed ? 1 : 0;
    parents_.needed += entry.is_parent ? 1 : 0;
  }
}

void FrameTable::need(const std::vector<std::string>& names) {
  std::set<std::string, std::less<>> needed(names.begin(), names.end());
  // The code below does not throw.
  needed_.swap(needed);
  placed_.needed = parents_.needed = 0;
  for (Entry& entry : entries_) entry.needed = false;
  for (const std::string& name : needed_) setNeeded(find(name));
}

bool FrameTable::setFree(std::set<std::string, std::less<>> names) {
  if (names == free_) return false;
  free_.swap(names);
  for (Entry& entry : entries_) entry.free = free_.count(*entry.name) != 0;
  return true;
}

const std::string& FrameTable::parentName(std::uint32_t frame) const {
  static const std::string none;
  const std::uint32_t parent = entries_[frame].parent;
  return parent == kNone ? none : *entries_[parent].name;
}

bool FrameTable::isInParent(std::uint32_t frame, std::string_view parent) const {
  const std::uint32_t number = entries_[frame].parent;
  return number != kNone && entries_[number].isNamed(parent);
}

}  // namespace hgrid
