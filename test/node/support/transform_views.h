// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <vector>

#include "src/node/wire/transform_view.h"

namespace hgrid {
namespace test {

/// Returns a view of a transform. It refers to the names of `transform`.
inline TransformView viewOf(const geometry_msgs::TransformStamped& transform) {
  const auto& t = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  return {transform.header.frame_id,
          transform.child_frame_id,
          Time(static_cast<std::int64_t>(transform.header.stamp.toNSec())),
          {t.x, t.y, t.z},
          {q.x, q.y, q.z, q.w}};
}

/// Returns views of all transforms of a message. They refer to its names.
inline std::vector<TransformView> viewsOf(const tf2_msgs::TFMessage& message) {
  std::vector<TransformView> views;
  for (const geometry_msgs::TransformStamped& transform : message.transforms) views.push_back(viewOf(transform));
  return views;
}

}  // namespace test
}  // namespace hgrid
