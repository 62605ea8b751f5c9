// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "node/markers/marker_colors.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Returns a white marker in the world frame. Its action is DELETE, which removes the marker of this namespace and id
/// from RViz. Set the action to ADD when there is something to draw.
visualization_msgs::Marker markerOf(const Tick& tick, const char* name_space, int id, int type);

/// Appends a line to a LINE_LIST and makes the marker visible.
void addLine(visualization_msgs::Marker& lines, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
             const std_msgs::ColorRGBA& color);

/// Returns a marker that deletes all markers of the topic. Publish it before all others.
visualization_msgs::Marker deleteAll(const Tick& tick);

/// A text at a point of the world.
struct Label {
  Eigen::Vector3d place;  ///< [m, world]
  std::string text;
};

/// Joins the texts of labels that are closer to each other than `apart`, so that no text covers another.
/// @param apart      [m] all labels of the result are at least this far apart
/// @param separator  is put between two joined texts
/// @returns the labels in their order; a joined label is at the place of its first text
std::vector<Label> joinedLabels(const std::vector<Label>& labels, double apart, const char* separator);

/// Returns `count` texts. The first of them show the labels, and the others remove texts of earlier ticks.
/// @param height  [m] of a line of text
std::vector<visualization_msgs::Marker> textsOf(const Tick& tick, const char* name_space, std::size_t count,
                                                double height, const std::vector<Label>& labels);

}  // namespace hgrid
