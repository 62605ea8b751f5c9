// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "hgrid_proximity/adapters/urdf.h"

namespace hgrid {
namespace test {

/// Returns the URDF text of a robot named "r".
inline std::string robot(const std::string& content) { return "<robot name=\"r\">\n" + content + "</robot>\n"; }

inline std::string link(const std::string& name, const std::string& content = "") {
  return "<link name=\"" + name + "\">" + content + "</link>\n";
}

inline std::string collision(const std::string& geometry, const std::string& origin = "") {
  return "<collision>" + origin + "<geometry>" + geometry + "</geometry></collision>";
}

inline std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                         const std::string& type = "fixed", const std::string& content = "") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" + child +
         "\"/>" + content + "</joint>\n";
}

/// Returns a tetrahedron, the smallest closed mesh, with each coordinate multiplied by `scale`.
inline std::shared_ptr<const TriangleMesh> tetrahedron(const Eigen::Vector3d& scale = Eigen::Vector3d::Ones()) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 0.125}};
  for (Eigen::Vector3d& v : mesh->vertices) v = v.cwiseProduct(scale);
  mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

/// A mesh loader. Returns a tetrahedron for "package://p/tetrahedron.stl" and refuses everything else.
inline std::shared_ptr<const TriangleMesh> knowsOneMesh(const std::string& uri, const Eigen::Vector3d& scale) {
  if (uri == "package://p/tetrahedron.stl") return tetrahedron(scale);
  throw Refusal(Code::resource_missing, "mesh '" + printable(uri) + "' does not exist");
}

inline RobotModel read(const std::string& urdf, const DescriptionLimits& limits = {}) {
  return readUrdf(urdf, knowsOneMesh, limits);
}

/// Returns the number of <collision> elements of all links of a URDF. Does not use the product's reader.
inline std::size_t collisionElements(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) throw std::runtime_error("not XML");
  std::size_t count = 0;
  for (const auto* link = document.RootElement()->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    for (const auto* c = link->FirstChildElement("collision"); c; c = c->NextSiblingElement("collision")) ++count;
  }
  return count;
}

/// Returns the number of shapes of a model, including the shapes that could not be read.
inline std::size_t accountedFor(const RobotModel& model) {
  std::size_t count = 0;
  for (const RobotLink& link : model.links) count += link.shapes.size() + link.unreadable.size();
  return count;
}

}  // namespace test
}  // namespace hgrid
