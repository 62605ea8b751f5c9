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

namespace hgrid {

struct Tick;

/// Finds out where the bodies were that ~map/self_filter names, so that the cells that sensors made of the robot itself
/// can be left out. Any thread.
class SelfShapes {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;

  SelfShapes(const Params& params, const TransformLookup& transforms, NewestTick newest)
      : params_(params), transforms_(transforms), newest_(std::move(newest)) {}

  /// Whether ~map/self_filter names any bodies.
  bool wanted() const { return !params_.map_self_filter.empty(); }
  /// Checks that at() can be complete.
  /// @throws Refusal not_ready if a robot is not loaded, or a named body never had a pose
  void require() const;
  /// The tf frames of the named bodies whose poses keep arriving.
  std::vector<std::string> frames() const;
  /// The padded shapes at a time (0: the newest). If tf does not know the pose of a body at that time, its pose in the
  /// newest tick is used. Bodies that never had a pose are left out.
  std::vector<SelfShape> at(Time stamp) const;
  /// The pose of a frame in the world at a time or, if that is not known, the newest one. An empty name is the world
  /// frame.
  /// @throws Refusal not_ready if neither is known
  Pose worldFrom(const std::string& frame, Time stamp) const;

 private:
  template <class Look>
  void forEach(const Look& look) const;

  const Params& params_;
  const TransformLookup& transforms_;
  NewestTick newest_;
};

}  // namespace hgrid
