// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <string>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

/// Limits for XML text. They protect the XML libraries.
struct DescriptionLimits {
  std::size_t max_bytes = 16u << 20;  ///< largest size of the text
  std::size_t max_depth = 98;         ///< largest depth of nested elements; tinyxml2 of Debian 12 takes no more
  std::size_t max_links = 2000;       ///< largest number of links
};

/// Returns the triangles of the mesh at a URI, with the scale applied. Throws Refusal if it cannot be read.
using MeshSource =
    std::function<std::shared_ptr<const TriangleMesh>(const std::string& uri, const Eigen::Vector3d& scale)>;

/// Returns whether a link without `<collision>` uses its `<visual>` geometry instead. The link is given by name.
using VisualChoice = std::function<bool(const std::string& link)>;

/// Checks that XML text is well-formed and that its root element is `<robot>`.
/// @param what  name of the text for the error sentence, such as "robot_description"
/// @throws Refusal limit if the text is too long or nested too deeply
/// @throws Refusal unsupported if the text has a DOCTYPE
/// @throws Refusal parse if the text is not well-formed or has another root element
void checkXml(const std::string& xml, const DescriptionLimits& limits, const std::string& what);

/// Reads a URDF: its links, its joints, and every `<collision>` of every link. In the result, parents come before their
/// children.
///
/// If a shape cannot be read, the robot is still read, and the shape is listed in RobotLink::unreadable. This also
/// holds for `<collision>` elements that urdfdom drops silently, and for the `<visual>` elements of a link that uses
/// its visual geometry.
/// @param takes_visual  may be empty; then no link uses its visual geometry
/// @throws Refusal with code parse, limit or unsupported if the text does not describe a robot
/// @throws Refusal with code bad_id for the name of a link
/// @throws Refusal with code nonfinite or out_of_range for the origin of a joint
RobotModel readUrdf(const std::string& xml, const MeshSource& meshes, const DescriptionLimits& limits = {},
                    const ShapeLimits& shape_limits = {}, const VisualChoice& takes_visual = {});

}  // namespace hgrid
