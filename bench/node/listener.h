// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/Status.h>
#include <ros/node_handle.h>

#include <mutex>
#include <string>

#include "sightings.h"

namespace hgrid {
namespace bench {

namespace msg = ::hgrid_proximity;

/// Subscribes to the topics of a node and stores what it receives. All callbacks run on one separate thread.
class Listener {
 public:
  /// @param node       name of the node
  /// @param distances  whether to subscribe to ~distances, too; with a subscriber, the node measures distances
  Listener(const std::string& node, bool distances);

  /// Adds everything that is received from now on to `sightings`. Null means that nothing is stored.
  void noteIn(Sightings* sightings);
  /// Returns whether the newest ~status of the node reports a complete world with `bodies` bodies.
  bool serves(std::size_t bodies) const;
  /// Returns text for an error message: the number of bodies in the newest ~status, and why the world is not complete.
  std::string troubles() const;

 private:
  static void ignore(const msg::Distances::ConstPtr&) {}
  void onPairs(const ros::MessageEvent<msg::Pairs const>& event);
  void onStatus(const msg::Status::ConstPtr& status);

  mutable std::mutex mutex_;
  Sightings* sightings_ = nullptr;
  msg::Status::ConstPtr newest_;
  ros::Time last_stamp_;
  ros::NodeHandle node_;
  ros::Subscriber pairs_, status_, distances_;
};

}  // namespace bench
}  // namespace hgrid
