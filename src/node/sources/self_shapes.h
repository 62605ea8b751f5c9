// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/maps/self_filter.h"
#include "node/params/params.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/newest_tick.h"

namespace hgrid {

/// Returns the shapes and poses of the bodies that ~map/self_filter names. They are needed to leave out cells in which
/// a sensor saw the robot itself. Any thread may use this class.
class SelfShapes {
 public:
  SelfShapes(const Params& params, const TransformLookup& transforms, NewestTick newest)
      : params_(params), transforms_(transforms), newest_(std::move(newest)) {}

  /// Whether ~map/self_filter names any bodies.
  bool wanted() const { return !params_.map_self_filter.empty(); }
  /// Checks that at() can return the shapes of all named bodies.
  /// @throws Refusal not_ready if a robot is not loaded, or if a named body never had a pose
  void require() const;
  /// Returns the tf frames of the named bodies whose poses are not LOST or worse.
  std::vector<std::string> frames() const;
  /// Returns the padded shapes of the named bodies at a time (0: in the newest tick). If tf does not know the pose of a
  /// body at that time, its pose in the newest tick is used. Bodies that never had a pose are left out.
  std::vector<SelfShape> at(Time stamp) const;
  /// Returns the pose of a frame in the world at a time (0: newest). If it is not known, returns the newest known pose.
  /// An empty name means the world frame.
  /// @throws Refusal not_ready if no pose is known
  Pose worldFrom(const std::string& frame, Time stamp) const;

 private:
  template <class Look>
  void forEach(const Look& look) const;

  const Params& params_;
  const TransformLookup& transforms_;
  NewestTick newest_;
};

}  // namespace hgrid
