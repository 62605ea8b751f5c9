// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/entering_bodies.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

void checkBody(const Body& body) {
  const std::size_t slash = body.name.find('/');
  if (slash == std::string::npos) {
    throw Refusal(Code::bad_id, "body name is '" + printable(body.name) + "'; it must have the form source/local");
  }
  checkSource(body.name.substr(0, slash), "source of body '" + printable(body.name) + "'");
  checkLocal(body.name.substr(slash + 1), "local name of body '" + printable(body.name) + "'");
  checkLength(body.margin, kLargestMargin, "margin of body '" + body.name + "'");
  if (!(body.max_speed >= 0.0)) {
    throw Refusal(Code::out_of_range,
                  "max_speed of body '" + body.name + "' is " + text(body.max_speed) + " m/s; it must not be negative");
  }
  if (body.links && body.link >= body.links->size()) {
    throw Refusal(Code::out_of_range, "link index of body '" + body.name + "' is " + std::to_string(body.link) +
                                          "; it must be smaller than the number of links of the robot, " +
                                          std::to_string(body.links->size()));
  }
  if (planesOf(body) > 0 && (body.kind != BodyKind::obstacle || body.mobility != Mobility::fixed)) {
    throw Refusal(Code::unsupported, "body '" + body.name +
                                         "' has a plane; only an obstacle that is fixed in the world " +
                                         "may have planes, because no speed bounds the motion of a plane");
  }
  for (const BodyShape& shape : body.shapes) {
    const std::string what = "pose of a shape of body '" + body.name + "'";
    if (!shape.body_from_shape.matrix().allFinite()) {
      throw Refusal(Code::nonfinite, what + " is not finite; every number in it must be finite");
    }
    checkWithin(shape.body_from_shape.translation(), kFarthestShape, what);
    checkLength(shape.padding, kLargestMargin, "padding of a shape of body '" + body.name + "'");
  }
}

}  // namespace

void checkLength(double value, double limit, const std::string& what) {
  if (!(value >= 0.0 && value <= limit)) {
    throw Refusal(Code::out_of_range, what + " is " + text(value) + " m; it must be within 0 .. " + text(limit) + " m");
  }
}

std::size_t planesOf(const Body& body) {
  return static_cast<std::size_t>(std::count_if(body.shapes.begin(), body.shapes.end(), [](const BodyShape& shape) {
    return shape.shape.kind() == ShapeKind::plane;
  }));
}

void checkEntering(const EnteringBodies& in, std::size_t count, std::size_t planes, const SceneOptions& options,
                   const std::function<bool(const std::string&)>& stays) {
  std::unordered_set<std::string_view> names;
  names.reserve(in.size());
  for (const auto& entering : in) {
    const Body& body = *entering;
    checkBody(body);
    if (stays(body.name) || !names.insert(body.name).second) {
      throw Refusal(Code::dup_id, "there is already a body '" + body.name + "'; every body must have its own name");
    }
    if (count++ >= options.max_bodies) {
      throw Refusal(Code::limit, "there is no room for body '" + body.name + "'; the world may have at most " +
                                     std::to_string(options.max_bodies) + " bodies (max_bodies)");
    }
    planes += planesOf(body);
    if (planes > options.max_planes) {
      throw Refusal(Code::limit, "there is no room for the planes of body '" + body.name +
                                     "'; the world may have at most " + std::to_string(options.max_planes) +
                                     " planes (max_planes)");
    }
  }
}

Refusal removedTwice(const Body& body) {
  return {Code::dup_id, "body '" + body.name + "' is to be removed twice; list it only once"};
}

bool isSameElsewhere(const Body& before, const Body& after) {
  const auto isObstacle = [](const Body& body) {
    return body.kind == BodyKind::obstacle && body.mobility == Mobility::fixed;
  };
  const auto isSameShape = [](const BodyShape& a, const BodyShape& b) {
    return a.solid && a.solid == b.solid && a.padding == b.padding &&
           a.body_from_shape.matrix() == b.body_from_shape.matrix();
  };
  return isObstacle(before) && isObstacle(after) && before.frame == after.frame && before.margin == after.margin &&
         before.group == after.group &&
         std::equal(before.shapes.begin(), before.shapes.end(), after.shapes.begin(), after.shapes.end(), isSameShape);
}

}  // namespace hgrid
