// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/scene.h"
#include "node/sources/source_id.h"
#include "node/time/kept_pose.h"

namespace hgrid {

/// A body that follows a frame, and its pose in that frame.
struct Member {
  BodyId body;
  bool at_frame = false;  ///< the pose is the identity
  Pose frame_from_body = Pose::Identity();
};

/// The bodies of one source that one tf frame places, and the pose of that frame that is in use.
struct Mover {
  std::string frame;
  SourceId source;
  std::size_t first = 0, last = 0;  ///< its members in Movers::members(), last excluded
  KeptPose pose{};
  bool settled = false;   ///< only a new transform on /tf_static can move it, and nothing is wrong with it
  bool conflict = false;  ///< a frame of its chain comes on /tf and on /tf_static
  std::optional<Refusal> trouble{};
};

/// Knows which bodies follow which tf frame.
///
/// A call that throws, also for lack of memory, has changed neither this nor the scene.
class Movers {
 public:
  class Change;

  /// @param scene  gets and loses the bodies; it must outlive this
  explicit Movers(Scene& scene) : scene_(scene) {}

  /// Adds one body that follows its `frame`.
  /// @throws Refusal as Scene::add()
  void add(const SourceId& source, Body body);
  /// The change that removes all movers of the sources for which `chosen` is true.
  Change changeWithout(const std::function<bool(const SourceId&)>& chosen) const;
  /// Makes a change in this and in the scene.
  /// @throws Refusal as Scene::exchange()
  void exchange(Change change);

  std::size_t size() const { return movers_.size(); }
  Mover& operator[](std::size_t index) { return movers_[index]; }
  std::vector<Mover>& all() { return movers_; }
  /// The members of all movers, in the order of the movers.
  const std::vector<Member>& members() const { return members_; }
  /// A number that is one more after each change.
  std::uint64_t revision() const { return revision_; }

 private:
  Scene& scene_;
  std::vector<Mover> movers_;
  std::vector<Member> members_;
  std::uint64_t revision_ = 0;
};

/// Movers and bodies that replace those of a Movers. They are built beside the old ones, so that exchange() can put
/// them into use as a whole.
class Movers::Change {
 public:
  /// Adds a mover with one body.
  void add(const std::string& frame, const SourceId& source, const Body& body, const Pose& frame_from_body);
  /// Adds a body to the mover that was added last.
  void join(const Body& body, const Pose& frame_from_body);

 private:
  friend class Movers;
  std::vector<Mover> movers_;
  std::vector<Member> members_;  // those of in_ come last, without their handles
  std::vector<BodyId> out_;      // bodies that leave the scene
  std::vector<Body> in_;         // bodies that enter it
};

}  // namespace hgrid
