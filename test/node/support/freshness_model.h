// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hgrid {
namespace test {

/// What a publisher says of a frame: where it is in its parent, along x.
struct Statement {
  std::string frame, parent, publisher;
  double x = 0.0;      ///< [m]
  double stamp = 0.0;  ///< [s]
  bool is_static = false;
};

/// Where each frame was last known to be, and when: the witness for the node. It keeps every statement and reads
/// definitions off them; it shares no code with the node. A frame is known between two statements of one publisher in
/// one parent that follow each other.
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
    double period = 0.0;     ///< [s] the frames of its chain may have this period, but no longer one
  };

  explicit FreshnessModel(std::vector<std::string> frames) : frames_(std::move(frames)) {}

  /// A statement arrives.
  void hear(const Statement& statement, double now);
  /// A refused statement arrives: until the next good one the frame is disputed.
  void hearRefused(const std::string& frame, double now);
  /// The ROS clock was set, and with it all stamps lose their meaning. Static statements stay.
  void forgetStamps(double jump);
  /// A tick of the node at time `time`, made at `now`. `elapsed`: since the tick before, by the clock that ages poses.
  void tick(double time, double now, double elapsed);

  const Known& known(const std::string& frame) const { return known_.at(frame); }
  /// Whether any choice of one publisher for each frame puts the frame at x at the time `stamp`.
  bool isSupported(const std::string& frame, double x, double stamp) const;

 private:
  using ByStamp = std::map<double, Statement>;

  struct Frame {
    ByStamp statements;  // on /tf
    std::optional<Statement> fixed, last;
    std::optional<double> newest;
    double step = 0.0, longest_period = 0.0;  // [s]
    double claim_begin = -1e18;               // stamp of the first statement in a row of one publisher in one parent
    double heard = -1e9, disputed_until = -1e9;
    std::string source, former_parent;
    std::vector<double> turns;                                        // when another source than before spoke
    std::map<std::pair<std::string, std::string>, ByStamp> by_claim;  // by publisher and parent, never forgotten
    std::vector<Statement> all_fixed, all;                            // as they arrived
  };

  void noteSource(Frame& frame, const Statement& statement, double now);
  static std::optional<Statement> interpolated(const ByStamp& statements, double time);
  static std::optional<Statement> between(const Statement& from, const Statement& to, double time);
  std::optional<Statement> statementAt(const Frame& frame, double time) const;
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
