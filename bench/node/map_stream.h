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

/// Publishes maps of a building (bench/maps/building.h), one after the other. Each map lacks 1 % of the leaves of the
/// map before and has as many other leaves, scattered over the building. The messages are like those of octomap_server
/// on octomap_binary, in the frame "map".
///
/// The constructor prepares ten maps, because creating a map takes far longer than sending it. After the tenth map, the
/// first one is sent again. Each map has a mark: one more leaf outside of the building. From map to map, the mark
/// changes between two places.
class MapStream {
 public:
  static constexpr std::size_t kLeaves = 1000000;
  static constexpr double kEdge = 0.05;  ///< [m] edge of the smallest leaves

  /// Prepares maps of `leaves` leaves and publishes the first one on `topic`.
  explicit MapStream(const std::string& topic, std::size_t leaves = kLeaves);

  void publishNext();
  /// Returns the number of maps published so far.
  std::size_t published() const { return published_; }
  /// Returns the approximate size of one message [byte].
  std::size_t messageBytes() const { return messages_.front().bytes.size(); }

  /// Returns the coordinate of the center of the mark in the first map, the third map and so on [m, frame "map"]. It is
  /// the same on all three axes.
  static double middleOfMark();

 private:
  std::vector<test::OctomapBytes> messages_;
  std::size_t published_ = 0;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
};

}  // namespace bench
}  // namespace hgrid
