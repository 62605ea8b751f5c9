// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <cstddef>
#include <string>
#include <vector>

#include "test/node/support/raw_message.h"

namespace hgrid {
namespace bench {

/// Maps of a building of 1,000,000 leaves (bench/maps/building.h), one after the other: of each the next differs in
/// 10,000 leaves that are gone and 10,000 that are new, scattered over all of it. As octomap_server's octomap_binary,
/// in the frame "map".
///
/// Ten of them are prepared, since making one takes far longer than sending it. Away from the building each has one
/// leaf by which it can be told from the one before.
class MapStream {
 public:
  static constexpr std::size_t kLeaves = 1000000;
  static constexpr double kEdge = 0.05;  ///< [m] of the smallest leaves

  /// Prepares them, and publishes the first one.
  explicit MapStream(const std::string& topic);

  void publishNext();
  /// How many were published.
  std::size_t published() const { return published_; }
  /// Bytes of one message, about.
  std::size_t messageBytes() const { return messages_.front().bytes.size(); }

  /// Coordinate [m, frame "map"], the same on all three axes, of the middle of a leaf that every other map has: the
  /// first one, the third and so on.
  static double middleOfMark();

 private:
  std::vector<test::OctomapBytes> messages_;
  std::size_t published_ = 0;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
};

}  // namespace bench
}  // namespace hgrid
