// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/source.h"

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

std::string sourceOf(const Body& body) {
  switch (body.kind) {
    case BodyKind::link:
      return body.robot;
    case BodyKind::obstacle:
      return "obstacle";
    case BodyKind::map:
    case BodyKind::cloud:
      return body.name;
    case BodyKind::track:
      return trackerOf(body.name);
  }
  return body.name;
}

std::string trackerOf(const std::string& name) {
  const std::size_t first = name.find('/');
  return first == std::string::npos ? name : name.substr(0, name.find('/', first + 1));
}

}  // namespace hgrid
