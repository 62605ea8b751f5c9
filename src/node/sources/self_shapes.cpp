// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/self_shapes.h"

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/params/body_params.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Calls `look` for each body of the newest tick that ~map/self_filter names, with the padding [m] configured for it.
template <class Look>
void SelfShapes::forEach(const Look& look) const {
  const std::shared_ptr<const Tick> tick = newest_();
  if (!tick || !tick->snapshot) return;
  const Snapshot& snapshot = *tick->snapshot;
  for (std::size_t i = 0; i < snapshot.structure().bodies.size(); ++i) {
    const Body& body = snapshot.structure().bodies[i];
    if (body.shapes.empty()) continue;
    const double padding = lastMatch(params_.map_self_filter, body.name, -1.0);
    if (padding >= 0.0) look(*tick, body, snapshot.poses()[i], padding);
  }
}

void SelfShapes::require() const {
  const std::shared_ptr<const Tick> tick = newest_();
  if (!tick || !tick->snapshot || tick->models->robots < tick->models->expected.size()) {
    throw Refusal(Code::not_ready,
                  "not all robots are loaded yet, so their cells cannot be left out as ~map/self_filter requires");
  }
  forEach([](const Tick&, const Body& body, const BodyPose& pose, double) {
    if (pose.state != Freshness::unplaced) return;
    throw Refusal(Code::not_ready, "body '" + body.name +
                                       "' has no pose yet, so its cells cannot be left out as ~map/self_filter "
                                       "requires");
  });
}

std::vector<std::string> SelfShapes::frames() const {
  std::vector<std::string> frames;
  forEach([&](const Tick&, const Body& body, const BodyPose& pose, double) {
    if (pose.state < Freshness::lost) frames.push_back(body.frame);
  });
  return frames;
}

std::vector<SelfShape> SelfShapes::at(Time stamp) const {
  std::vector<SelfShape> shapes;
  forEach([&](const Tick& tick, const Body& body, const BodyPose& pose, double padding) {
    const std::optional<FramePose> world_from_frame = transforms_.at(tick.world_frame, body.frame, stamp);
    if (!world_from_frame && pose.state == Freshness::unplaced) return;
    const Pose world_from_body =
        world_from_frame ? world_from_frame->pose() * body.frame_from_body : pose.world_from_body;
    for (const BodyShape& shape : body.shapes) {
      shapes.push_back({shape.shape, shape.solid, world_from_body * shape.body_from_shape, shape.padding + padding});
    }
  });
  return shapes;
}

Pose SelfShapes::worldFrom(const std::string& frame, Time stamp) const {
  const std::shared_ptr<const Tick> tick = newest_();
  if (tick && !tick->world_frame.empty()) {
    if (frame.empty()) return Pose::Identity();
    if (const auto pose = transforms_.at(tick->world_frame, frame, stamp)) return pose->pose();
    if (const auto pose = transforms_.newest(tick->world_frame, frame)) return pose->pose();
  }
  throw Refusal(Code::not_ready, "frame '" + printable(frame) +
                                     "' is not connected to the world frame yet, so the robot's own cells cannot be "
                                     "left out as ~map/self_filter requires");
}

}  // namespace hgrid
