// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/configured_obstacle.h"

#include <chrono>
#include <cmath>

#include "node/params/body_params.h"

namespace hgrid {

std::shared_ptr<const RequestedObstacle> requestedOf(const ObstacleParams& configured, const Params& params,
                                                     NarrowPhase& narrow_phase) {
  auto what = std::make_shared<RequestedObstacle>();
  what->body = configured.body;
  completeObstacle(params, configured.margin, configured.max_speed, narrow_phase, what->body);
  what->place = {configured.body.frame, configured.body.frame_from_body, std::nullopt};
  what->moving = configured.moving;
  what->lost_at_end = configured.lost_at_end;
  what->owner = configured.owner;
  what->lifetime = std::chrono::nanoseconds(std::llround(1e9 * configured.lifetime));
  return what;
}

std::shared_ptr<const Attachment> attachmentOf(const ObstacleParams& configured) {
  if (!configured.attached) return nullptr;
  auto attachment = std::make_shared<Attachment>();
  attachment->link = configured.attached->link;
  attachment->link_from_body = configured.attached->link_from_body;
  attachment->touch = configured.attached->touch;
  attachment->owner = configured.owner;
  return attachment;
}

}  // namespace hgrid
