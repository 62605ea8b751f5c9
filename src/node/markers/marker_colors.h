// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <std_msgs/ColorRGBA.h>

#include <optional>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

// The colors of ~markers. Each has one meaning; README.md has the legend. People who confuse red and green can
// distinguish the colors, too (after Okabe and Ito, 2008).
//
//   blue    a link of a robot
//   beige   an obstacle; darker: the cells of a map or cloud
//   violet  a track: a person or a vehicle
//   yellow  a body that is near another, whatever its kind: the nearer, the more orange; orange: in contact. A mixture
//           with the color of the kind would be gray for links and red for tracks.
//   orange  in contact; a query that is HIT
//   gray    not known: a body whose pose is STALE or worse, a pair that was not measured, a query that is UNKNOWN
//   red     the world is NOT COMPLETE: nothing else is red
//   green   a query that is CLEAR; a door
//   white   texts, lines of measured pairs

std_msgs::ColorRGBA rgba(double red, double green, double blue, double alpha);

/// @param nearness  0: at the margin of another body; 1: in contact; nullopt: near nothing
std_msgs::ColorRGBA colorOfBody(BodyKind kind, Freshness state, std::optional<double> nearness);

std_msgs::ColorRGBA orange(double alpha);
std_msgs::ColorRGBA gray(double alpha);
std_msgs::ColorRGBA red();
std_msgs::ColorRGBA white();

}  // namespace hgrid
