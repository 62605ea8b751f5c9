// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hgrid {
namespace test {

/// A transform that a publisher sends: the position of a frame along the x axis of its parent, at one time.
struct PublishedTransform {
  std::string frame, parent, publisher;
  double x = 0.0;      ///< [m] position of `frame` along the x axis of `parent`
  double stamp = 0.0;  ///< [s] time for which the transform is valid
  bool is_static = false;
};

/// An independent reference for the node. It computes the last known position of each frame, and the time of this
/// position.
///
/// The model stores all published transforms and computes everything from them by definition. It shares no code with
/// the node. The position of a frame is known between two successive transforms of the same publisher with the same
/// parent.
///
/// All times are in s, positions in m. All frames move along x. The world frame is "base".
class FreshnessModel {
 public:
  /// What the model knows about one frame. The chain of a frame is the frame, its parent and so on, up to the world
  /// frame.
  struct Known {
    double x = 0.0, stamp = 0.0, age = 0.0;
    bool placed = false;
    bool moves = false;      ///< whether a frame of the chain is not static
    bool at_tick = false;    ///< whether the position at the time of the newest tick is known
    bool contested = false;  ///< whether a frame of the chain has several publishers; if so, the model predicts no
                             ///< state
    bool fought = false;     ///< whether the publishers of a frame of the chain alternate; if so, the state must not be
                             ///< FRESH
    bool connected = false;  ///< whether the newest transforms of the chain lead to the world frame
    double period = 0.0;     ///< [s] longest publishing period of all frames of the chain
  };

  explicit FreshnessModel(std::vector<std::string> frames) : frames_(std::move(frames)) {}

  /// Stores a transform that arrives at the time `now`.
  void hear(const PublishedTransform& transform, double now);
  /// Records that the node refused a transform of this frame. The frame is contested for the next 4 s.
  void hearRefused(const std::string& frame, double now);
  /// Drops the stamps of all transforms from /tf, because the ROS clock jumped by `jump`. Static transforms stay valid.
  void forgetStamps(double jump);
  /// Predicts the poses of the tick that the node makes at the time `now`.
  /// @param time     the time of the tick: all poses are taken at this time
  /// @param elapsed  time since the previous tick, by the clock that measures the age of poses
  void tick(double time, double now, double elapsed);

  const Known& known(const std::string& frame) const { return known_.at(frame); }
  /// Returns whether one can choose one publisher for each frame so that the frame is at x at the time `stamp`.
  bool isSupported(const std::string& frame, double x, double stamp) const;

 private:
  using ByStamp = std::map<double, PublishedTransform>;

  struct Frame {
    ByStamp transforms;  // transforms from /tf by stamp
    std::optional<PublishedTransform> fixed, last;
    std::optional<double> newest;
    double step = 0.0, longest_period = 0.0;  // [s]
    double claim_begin = -1e18;               // first stamp after a change of publisher or parent
    double heard = -1e9, contested_until = -1e9;
    std::string source, former_parent;
    std::vector<double> turns;                                        // times at which another publisher took over
    std::map<std::pair<std::string, std::string>, ByStamp> by_claim;  // from /tf
    std::vector<PublishedTransform> all_fixed, all;  // from /tf_static and from /tf, each in order of arrival
  };

  void noteSource(Frame& frame, const PublishedTransform& transform, double now);
  static std::optional<PublishedTransform> interpolated(const ByStamp& transforms, double time);
  static std::optional<PublishedTransform> between(const PublishedTransform& from, const PublishedTransform& to,
                                                   double time);
  std::optional<PublishedTransform> transformAt(const Frame& frame, double time) const;
  std::optional<double> positionAt(const std::string& frame, double time) const;
  bool isChainKnown(const std::string& frame, double time) const;
  std::optional<double> newestTime(const std::string& frame, double time) const;
  void look(const std::string& frame, double now, Known& known) const;

  std::vector<std::string> frames_;
  std::map<std::string, Frame> heard_;
  std::map<std::string, Known> known_;
};

}  // namespace test
}  // namespace hgrid
