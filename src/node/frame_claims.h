// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "frame_pose.h"
#include "hgrid_proximity/scene/body.h"

namespace hgrid {

/// Who places a frame, and in which parent.
struct FrameClaim {
  std::string publisher, parent;
};

/// Remembers frames that more than one publisher places, and reports those over which publishers fight.
///
/// One publisher at a time holds a frame: its transforms are used. Another one is a rival. The rival's transform waits
/// here until the holder has spoken of the same time, since only then can the two be compared.
/// Frames are known by their numbers in the TfIntake. Readings are those of the AgeClock.
class FrameClaims {
 public:
  /// What a rival said.
  struct Word {
    FrameClaim claim;
    Time stamp{0};
    FramePose parent_from_frame;
  };

  /// [ns] A frame is contested for this long after publishers contradicted each other.
  static constexpr Time kMemory{3000000000};

  /// Keeps what a rival said, unless a word of a rival waits already.
  void keep(std::uint32_t frame, const Word& word);
  /// Returns the word that waits and that the holder has caught up with, and forgets it.
  std::optional<Word> take(std::uint32_t frame, Time holders_newest);
  /// Another claim is used from now on. Returns whether it was left less than kMemory ago: the two take turns.
  bool change(std::uint32_t frame, const FrameClaim& from, const FrameClaim& to, Time reading);
  /// Two claims contradict each other: the frame is contested for a while.
  void contradict(std::uint32_t frame, const std::string& name, const FrameClaim& holder, const FrameClaim& rival,
                  Time reading);
  /// Forgets words and changes, since the clock jumped. Fights go on.
  void forgetWords();

  bool isContested(std::uint32_t frame, Time reading) const;
  /// What is wrong with a frame that was contested.
  const std::string& sentence(std::uint32_t frame) const { return entries_.at(frame).sentence; }
  /// The sentences of all frames that are contested, sorted.
  std::vector<std::string> sentences(Time reading) const;

 private:
  struct Entry {
    std::optional<Word> waiting;
    std::optional<FrameClaim> left;  // the claim that was used before
    Time left_at{0};
    std::string sentence;
    std::optional<Time> contested_until;
  };

  std::unordered_map<std::uint32_t, Entry> entries_;
};

}  // namespace hgrid
