// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include "node/tick/tick.h"

namespace hgrid {

std_msgs::ColorRGBA rgba(double red, double green, double blue, double alpha);

/// Returns a white marker in the world frame. Its action is DELETE, which removes the marker of this namespace and id
/// from RViz. Set the action to ADD when there is something to draw.
visualization_msgs::Marker markerOf(const Tick& tick, const char* name_space, int id, int type);

/// Appends a line to a LINE_LIST and makes the marker visible.
void addLine(visualization_msgs::Marker& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             const std_msgs::ColorRGBA& color);

/// Returns a marker that deletes all markers of the topic. Publish it before all others.
visualization_msgs::Marker deleteAll(const Tick& tick);

}  // namespace hgrid
