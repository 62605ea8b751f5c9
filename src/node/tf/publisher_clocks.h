// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// A publisher whose stamps are constantly ahead of ROS time, or constantly behind it.
struct ClockOffset {
  std::string publisher;
  double offset = 0.0;  ///< [s] stamp minus time of arrival: at least this far ahead (positive) or behind (negative)
};

/// Finds publishers of /tf whose stamps are constantly early or late, for example because the clock of their computer
/// differs.
///
/// The stamps of a publisher are judged in windows of two seconds. They are constantly ahead or behind if all messages
/// of a window are. Readings are readings of the AgeClock.
class PublisherClocks {
 public:
  static constexpr Time kWindow{2000000000};
  static constexpr Time kAhead{20000000};              ///< stamps that are less ahead are not reported
  static constexpr Time kBehind{100000000};            ///< stamps that are less behind are not reported
  static constexpr std::size_t kLeastMessages = 5;     ///< a window with fewer messages is not judged
  static constexpr std::size_t kMaxPublishers = 1000;  ///< further publishers are not judged while these are active

  /// Notes a message. @param offset  its newest stamp minus the ROS time when it arrived
  void note(const std::string& publisher, Time offset, Time reading);
  /// Returns the publishers whose newest complete window was constantly ahead or behind, the largest offset first. A
  /// publisher that has sent nothing for two windows is left out.
  std::vector<ClockOffset> offsets(Time reading) const;
  /// Forgets everything. Call this after the clock jumped.
  void forget() { entries_.clear(); }

 private:
  struct Window {
    Time begin{0};
    std::size_t messages = 0;
    Time least{0}, largest{0};  // of the offsets
  };
  struct Entry {
    Window current;
    Window judged;  // the newest complete window
  };
  bool makeRoom(Time reading);

  std::map<std::string, Entry> entries_;  // by publisher
};

}  // namespace hgrid
