// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_claims.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

bool isSame(const FrameClaim& a, const FrameClaim& b) { return a.publisher == b.publisher && a.parent == b.parent; }

std::string sentenceOf(const std::string& frame, const FrameClaim& a, const FrameClaim& b) {
  const std::string who = "frame '" + printable(frame) + "' comes from " + printable(a.publisher) + " with parent '" +
                          printable(a.parent) + "' and from " + printable(b.publisher) + " with parent '" +
                          printable(b.parent) + "'";
  return who + (a.parent == b.parent ? " at different poses" : "") + "; only one publisher may place a frame";
}

}  // namespace

void FrameClaims::keep(std::uint32_t frame, const RivalTransform& transform) {
  Entry& entry = entries_[frame];
  if (!entry.waiting) entry.waiting = transform;
}

std::optional<FrameClaims::RivalTransform> FrameClaims::take(std::uint32_t frame, Time holders_newest) {
  const auto found = entries_.find(frame);
  if (found == entries_.end() || !found->second.waiting || found->second.waiting->stamp > holders_newest) {
    return std::nullopt;
  }
  std::optional<RivalTransform> transform;
  transform.swap(found->second.waiting);
  return transform;
}

bool FrameClaims::change(std::uint32_t frame, const FrameClaim& from, const FrameClaim& to, Time reading) {
  Entry& entry = entries_[frame];
  const bool back = entry.left && isSame(*entry.left, to) && reading - entry.left_at <= kMemory;
  entry.left = from;
  entry.left_at = reading;
  entry.waiting.reset();
  return back;
}

void FrameClaims::contradict(std::uint32_t frame, const std::string& name, const FrameClaim& holder,
                             const FrameClaim& rival, Time reading) {
  Entry& entry = entries_[frame];
  const bool in_order =
      holder.publisher != rival.publisher ? holder.publisher < rival.publisher : holder.parent < rival.parent;
  entry.sentence = in_order ? sentenceOf(name, holder, rival) : sentenceOf(name, rival, holder);
  entry.contested_until = reading + kMemory;
}

void FrameClaims::forgetTransforms() {
  for (auto& numbered : entries_) {
    numbered.second.waiting.reset();
    numbered.second.left.reset();
  }
}

bool FrameClaims::isContested(std::uint32_t frame, Time reading) const {
  const auto found = entries_.find(frame);
  return found != entries_.end() && found->second.contested_until && reading < *found->second.contested_until;
}

std::vector<std::string> FrameClaims::sentences(Time reading) const {
  std::vector<std::string> sentences;
  for (const auto& numbered : entries_) {
    if (isContested(numbered.first, reading)) sentences.push_back(numbered.second.sentence);
  }
  std::sort(sentences.begin(), sentences.end());
  return sentences;
}

}  // namespace hgrid
