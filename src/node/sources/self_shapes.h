// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2/buffer_core.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/maps/self_filter.h"
#include "node/params/params.h"

namespace hgrid {

struct Tick;

/// The pose of a frame in another at a time (0: the newest), if tf knows it.
std::optional<Pose> poseAt(const tf2::BufferCore& buffer, const std::string& target, const std::string& frame,
                           Time stamp, std::string* why_not = nullptr);

/// Finds the poses of the shapes that ~map/self_filter names: sensors may have seen these parts of the robot. Any
/// thread.
class SelfShapes {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;

  SelfShapes(const Params& params, const tf2::BufferCore& buffer, NewestTick newest)
      : params_(params), buffer_(buffer), newest_(std::move(newest)) {}

  bool wanted() const { return !params_.map_self_filter.empty(); }
  /// @throws Refusal not_ready if robots are not loaded, or a body in question never had a pose
  void require() const;
  /// The tf frames of the bodies in question whose poses keep coming.
  std::vector<std::string> frames() const;
  /// The shapes at a time (0: the newest), padded; where tf does not know that, at the newest tick. What never had a
  /// pose is left out.
  std::vector<SelfShape> at(Time stamp) const;
  /// Where a map that follows a frame was. @throws Refusal not_ready if that is not known
  Pose worldFrom(const std::string& frame, Time stamp) const;

 private:
  template <class Look>
  void forEach(const Look& look) const;

  const Params& params_;
  const tf2::BufferCore& buffer_;
  NewestTick newest_;
};

}  // namespace hgrid
