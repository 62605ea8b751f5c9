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
  }
  return body.name;
}

}  // namespace hgrid
