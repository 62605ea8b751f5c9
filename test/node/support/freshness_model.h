// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hgrid {
namespace test {

/// A stretch of what one publisher says of one frame: it moves along x in one parent at a constant speed. So whatever
/// lies between two of its statements is known exactly.
struct Segment1d {
  int number = 0;
  std::string frame, parent, publisher;
  double x = 0.0, speed = 0.0;  ///< [m] at time 0, [m/s]
  bool is_static = false;

  double at(double time) const { return x + speed * time; }
};

/// Where each frame was last known to be, and when: the witness for the node. It keeps every statement and reads
/// definitions off them; it shares no code with the node.
///
/// Times are in s. All frames move along x; the world frame is "base".
class FreshnessModel {
 public:
  struct Known {
    double x = 0.0, stamp = 0.0, age = 0.0;
    bool placed = false;
    bool moves = false;      ///< its chain has a frame that is not static
    bool at_tick = false;    ///< it is known at the time of the newest tick
    bool disputed = false;   ///< several sources speak of a frame of its chain: nothing is said of its state
    bool fought = false;     ///< they take turns, so that it cannot be fresh
    bool connected = false;  ///< the newest statements lead to the world frame
  };

  explicit FreshnessModel(std::vector<std::string> frames) : frames_(std::move(frames)) {}

  /// A statement arrives.
  void hear(const Segment1d& segment, double stamp, double now);
  /// A refused statement arrives: until the next good one the frame is disputed.
  void hearRefused(const std::string& frame, double now);
  /// The ROS clock was set, and with it all stamps lose their meaning. Static statements stay.
  void forgetStamps(double jump);
  /// A tick of the node at time `time`, made at `now`. `elapsed`: since the tick before, by the clock that ages poses.
  void tick(double time, double now, double elapsed);

  const Known& known(const std::string& frame) const { return known_.at(frame); }
  /// Whether segments that were ever spoken of put the frame at x at the time `stamp`.
  bool isSupported(const std::string& frame, double x, double stamp) const;

 private:
  struct Frame {
    std::map<double, Segment1d> statements;  // by stamp; of the /tf
    std::optional<Segment1d> fixed;
    std::optional<double> newest;
    double heard = -1e9, disputed_until = -1e9;
    std::string source, former_parent;
    std::vector<double> turns;  // when another source than before spoke
    std::vector<Segment1d> segments;
  };

  void noteSource(Frame& frame, const Segment1d& segment, double now);
  const Segment1d* segmentAt(const Frame& frame, double time) const;
  std::optional<double> positionAt(const std::string& frame, double time) const;
  std::optional<double> newestTime(const std::string& frame, double time) const;
  void look(const std::string& frame, double now, Known& known) const;

  std::vector<std::string> frames_;
  std::map<std::string, Frame> heard_;
  std::map<std::string, Known> known_;
};

}  // namespace test
}  // namespace hgrid
