// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

namespace hgrid {
namespace test {

// Functions that build the URDF text of small robots for tests.

inline std::string urdf(const std::string& content) { return "<robot name=\"r\">" + content + "</robot>"; }

inline std::string link(const std::string& name, const std::string& content = "") {
  return "<link name=\"" + name + "\">" + content + "</link>";
}

inline std::string collision(const std::string& geometry, const std::string& xyz = "0 0 0") {
  return "<collision><origin xyz=\"" + xyz + "\"/><geometry>" + geometry + "</geometry></collision>";
}

inline std::string sphereOf(double radius, const std::string& xyz = "0 0 0") {
  return collision("<sphere radius=\"" + std::to_string(radius) + "\"/>", xyz);
}

inline std::string joint(const std::string& parent, const std::string& child, const std::string& type = "continuous",
                         const std::string& content = "") {
  return "<joint name=\"" + parent + "_" + child + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/>" + content + "</joint>";
}

/// Returns a URDF <visual>. Its <material> has no name, therefore urdfdom refuses the <visual>.
inline std::string visual(const std::string& geometry, const std::string& xyz = "0 0 0") {
  return "<visual><origin xyz=\"" + xyz + "\"/><geometry>" + geometry + "</geometry><material/></visual>";
}

/// Returns a URDF with a root link "base" and one link for each of `names`. A continuous joint connects each link to
/// "base", so that a test may place it on /tf or on /tf_static. Each link has a sphere of radius 0.1 m at its origin.
/// The sphere of "base" is 5 m below its origin, far from the others. Because of this sphere, "base" is a body even in
/// a robot without other links.
inline std::string balls(const std::vector<std::string>& names) {
  std::string content = link("base", sphereOf(0.1, "0 0 -5"));
  for (const std::string& name : names) content += link(name, sphereOf(0.1)) + joint("base", name);
  return urdf(content);
}

}  // namespace test
}  // namespace hgrid
