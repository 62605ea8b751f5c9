// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/changeable_params.h"

#include <utility>

#include "node/params/param_table.h"

namespace hgrid {
namespace {

/// A visitor that collects the parameters that may change. The table marks only flags, integers and numbers.
class ChangeableCollector {
 public:
  void changeable() { next_ = true; }
  void flag(const char* name, bool value, const char* meaning) { add(name, "", meaning, value, false, true); }
  void integer(const char* name, int value, int low, int high, const char* meaning) {
    add(name, "", meaning, value, low, high);
  }
  void number(const char* name, double value, const char* unit, double low, double high, const char* meaning) {
    add(name, unit, meaning, value, low, high);
  }

  void section(const char*) {}
  void string(const char*, const std::string&, const char*) {}
  void vector(const char*, const Eigen::Vector3d&, const char*, double, const char*) {}
  void kinds(const char*, const PairKinds&, const char*) {}
  void unknownSpace(const char*, UnknownSpace, const char*) {}
  void broadPhase(const char*, BroadPhaseType, const char*) {}
  void strings(const char*, const std::vector<std::string>&, const char*) {}
  void robots(const char*, const std::vector<RobotParams>&, const char*) {}
  void waivers(const char*, const std::vector<Waiver>&, const char*) {}
  void rooms(const char*, const std::vector<Room>&, const char*) {}
  void doors(const char*, const std::vector<Portal>&, const char*) {}
  void allowed(const char*, const std::vector<PairRule>&, const char*) {}
  void obstacles(const char*, const std::vector<ObstacleParams>&, const char*) {}
  void maps(const char*, const std::vector<MapParams>&, const char*) {}
  void clouds(const char*, const std::vector<CloudParams>&, const char*) {}
  void pathTopics(const char*, const std::vector<PathTopicParams>&, const char*) {}
  void trackers(const char*, const std::vector<TrackerParams>&, const char*) {}
  void pairMargins(const char*, const std::vector<PairMargin>&, double, double, const char*) {}
  void values(const char*, const std::vector<PatternValue>&, const char*, const char*, double, double, const char*) {}

  std::vector<ChangeableParam> take() { return std::move(params_); }

 private:
  template <class Value>
  void add(const char* name, const std::string& unit, const char* meaning, Value value, Value low, Value high) {
    if (!std::exchange(next_, false)) return;
    params_.push_back({name, (unit.empty() ? "" : "[" + unit + "] ") + meaning, value, low, high});
  }

  bool next_ = false;
  std::vector<ChangeableParam> params_;
};

}  // namespace

std::vector<ChangeableParam> changeableParams(const Params& params) {
  Params copy = params;  // a visitor may write to the parameters, but this one does not
  ChangeableCollector collector;
  visitParams(collector, copy);
  return collector.take();
}

}  // namespace hgrid
