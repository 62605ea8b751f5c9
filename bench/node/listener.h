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

/// Hears what a node says. Callbacks run on one other thread.
class Listener {
 public:
  /// @param node       its name
  /// @param distances  somebody listens to its ~distances
  Listener(const std::string& node, bool distances);

  /// From now on what is heard is added there; null: nowhere.
  void noteIn(Sightings* sightings);
  /// Whether the whole world is known, so many bodies, and the node has ticked on.
  bool serves(std::size_t bodies) const;
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
