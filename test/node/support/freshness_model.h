// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hgrid {
namespace test {

/// What a publisher says about a frame: its position along the x axis of its parent, at a time.
struct Statement {
  std::string frame, parent, publisher;
  double x = 0.0;      ///< [m]
  double stamp = 0.0;  ///< [s]
  bool is_static = false;
};

/// An independent reference for the node: the last known position and time of each frame.
///
/// It stores all statements and computes everything from them by definition. It shares no code with the node. The
/// position of a frame is known between two successive statements of the same publisher about the same parent.
///
/// All times are in s, positions in m. All frames move along x. The world frame is "base".
class FreshnessModel {
 public:
  /// What is known about one frame. Its chain is the frame, its parent and so on, up to the world frame.
  struct Known {
    double x = 0.0, stamp = 0.0, age = 0.0;
    bool placed = false;
    bool moves = false;      ///< a frame of the chain is not static
    bool at_tick = false;    ///< the position at the time of the newest tick is known
    bool disputed = false;   ///< a frame of the chain has several sources; the model predicts no state
    bool fought = false;     ///< several sources of a frame of the chain alternate, so the state cannot be FRESH
    bool connected = false;  ///< the newest statements of the chain lead to the world frame
    double period = 0.0;     ///< [s] longest period at which a frame of the chain may be published
  };

  explicit FreshnessModel(std::vector<std::string> frames) : frames_(std::move(frames)) {}

  /// Takes in a statement that arrives at the time `now`.
  void hear(const Statement& statement, double now);
  /// Takes in a statement that the node refuses. The frame is disputed for a while.
  void hearRefused(const std::string& frame, double now);
  /// Drops the stamps of all statements on /tf, because the ROS clock jumped by `jump`. Static statements stay valid.
  void forgetStamps(double jump);
  /// Predicts the tick that the node makes at `now` for the time `time`. `elapsed` is the time since the previous tick,
  /// by the clock that poses age by.
  void tick(double time, double now, double elapsed);

  const Known& known(const std::string& frame) const { return known_.at(frame); }
  /// Whether there is a choice of one publisher per frame that places the frame at x at the time `stamp`.
  bool isSupported(const std::string& frame, double x, double stamp) const;

 private:
  using ByStamp = std::map<double, Statement>;

  struct Frame {
    ByStamp statements;  // from /tf
    std::optional<Statement> fixed, last;
    std::optional<double> newest;
    double step = 0.0, longest_period = 0.0;  // [s]
    double claim_begin = -1e18;               // first stamp of the newest run of one publisher and one parent
    double heard = -1e9, disputed_until = -1e9;
    std::string source, former_parent;
    std::vector<double> turns;                                        // times at which the source changed
    std::map<std::pair<std::string, std::string>, ByStamp> by_claim;  // by publisher and parent, never dropped
    std::vector<Statement> all_fixed, all;                            // in order of arrival
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
