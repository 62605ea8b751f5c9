// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
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
  bool at_frame = false;  ///< whether frame_from_body is the identity
  Pose frame_from_body = Pose::Identity();
};

/// The bodies of one source that follow one tf frame, and the stamp and age of the frame's pose in use.
struct Mover {
  std::string frame;
  SourceId source;
  std::size_t first = 0, last = 0;  ///< indices of its members in Movers::members(): first .. last - 1
  KeptPose pose{};
  bool settled = false;              ///< whether nothing is wrong with it and only new static transforms can move it
  bool given_up = false;             ///< whether it keeps its pose and is LOST, whatever its frame does
  bool begins_lost = false;          ///< whether it is LOST at its first pose already, and then given up
  bool conflict = false;             ///< whether a frame of its chain is published on both /tf and /tf_static
  std::optional<Refusal> trouble{};  ///< what is wrong with its frame
};

/// Movers and their bodies, which Movers::exchange() adds. Any thread may make them.
class NewMovers {
 public:
  /// Makes room for further movers with one body each.
  void reserve(std::size_t bodies);
  /// Adds a mover with one body, which follows its `frame`.
  void add(const SourceId& source, Body body);
  /// Adds a mover with one body, which follows another frame.
  void add(const std::string& frame, const SourceId& source, Body body, const Pose& frame_from_body);
  /// Adds a body to the mover that was added last.
  void join(Body body, const Pose& frame_from_body);
  /// Prepares the scene for these bodies, so that Movers::exchange() takes less time. Call this last, and only once.
  /// @param newest  see Scene::prepare(), also for `out` and `rules`
  /// @throws Refusal as Scene::prepare(). Then this object may only be destroyed.
  void prepare(const Scene& scene, const Snapshot& newest, const std::vector<std::string>& out,
               const std::optional<std::vector<PairRule>>& rules);

  /// Returns whether there are neither new movers nor anything that was prepared.
  bool empty() const { return movers_.empty() && !prepared_; }

 private:
  friend class Movers;
  std::vector<Mover> movers_;               // `first` and `last` are indices into members_
  std::vector<Member> members_;             // their `body` is not set yet
  std::vector<Body> in_;                    // the bodies, in the order of members_; empty after prepare()
  std::optional<PreparedBodies> prepared_;  // the bodies after prepare()
};

/// Stores which bodies follow which tf frame.
///
/// A call that throws, even because memory ran out, changes neither this object nor the scene.
class Movers {
 public:
  /// @param scene  bodies are added to it and removed from it; it must outlive this object
  explicit Movers(Scene& scene) : scene_(scene) {}

  /// Adds one body that follows its `frame`.
  /// @throws Refusal as Scene::add()
  void add(const SourceId& source, Body body);
  /// Removes all movers of the sources for which `leaves` returns true, and adds other movers. Changes this object and
  /// the scene.
  /// @param leaves  null: no mover is removed
  /// @param coming  the movers that are added. What takes long to destroy stays in it.
  /// @throws Refusal as Scene::exchange()
  void exchange(const std::function<bool(const SourceId&)>& leaves, NewMovers&& coming);

  /// Lets obstacles keep their poses and be LOST from the next tick on. @param names  full names
  void giveUp(const std::set<std::string>& names) noexcept;
  /// Lets obstacles that have no pose yet be LOST at their first pose, which they keep. @param names  full names
  void beginLost(const std::set<std::string>& names) noexcept;

  std::size_t size() const { return movers_.size(); }
  Mover& operator[](std::size_t index) { return movers_[index]; }
  std::vector<Mover>& all() { return movers_; }
  /// Returns the members of all movers, in the order of the movers.
  const std::vector<Member>& members() const { return members_; }
  /// Returns a number that increases with each change.
  std::uint64_t revision() const { return revision_; }
  /// Returns whether all changes after this revision only added movers at the end of all().
  bool onlyAddedSince(std::uint64_t revision) const { return revision >= reordered_; }

 private:
  void remove(const std::vector<std::size_t>& leaving) noexcept;

  Scene& scene_;
  std::vector<Mover> movers_;
  std::vector<Member> members_;
  std::uint64_t revision_ = 0;
  std::uint64_t reordered_ = 0;  // revision of the newest change that was more than an addition
};

}  // namespace hgrid
