// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <string>

#include "hgrid_proximity/bodies/robot_model.h"

namespace hgrid {

/// Bounds on what goes into the XML libraries.
struct DescriptionLimits {
  std::size_t max_bytes = 16u << 20;  ///< of the text
  std::size_t max_depth = 256;        ///< of nested elements: the parsers recurse
  std::size_t max_links = 2000;
};

/// Turns a mesh's URI and scale into its triangles, scale applied. @throws Refusal
using MeshSource =
    std::function<std::shared_ptr<const TriangleMesh>(const std::string& uri, const Eigen::Vector3d& scale)>;

/// Says of a link, by its name, whether its `<visual>` geometry is taken if it has no `<collision>`.
using VisualChoice = std::function<bool(const std::string& link)>;

/// Refuses XML text that the libraries must not see: too long, too deep, with a DOCTYPE, not well-formed.
/// @param what  names the text in the sentence, as in "robot_description"
/// @throws Refusal limit, parse (with the line), unsupported
void checkXml(const std::string& xml, const DescriptionLimits& limits, const std::string& what);

/// Reads a URDF: every `<collision>` of every link with its origin. The links are sorted parents first.
///
/// A shape that cannot be read does not stop the robot: it is listed in RobotLink::unreadable. Every
/// `<collision>` element is accounted for, also those that urdfdom drops silently. The same holds for the `<visual>`
/// elements of a link that are taken in place of the `<collision>` elements that the link does not have.
/// @param takes_visual  empty: no visual geometry is taken
/// @throws Refusal parse, limit, unsupported, bad_id (a link's name) or out_of_range (a joint's origin) when there
/// is no robot to be had from the text.
RobotModel readUrdf(const std::string& xml, const MeshSource& meshes, const DescriptionLimits& limits = {},
                    const ShapeLimits& shape_limits = {}, const VisualChoice& takes_visual = {});

}  // namespace hgrid
