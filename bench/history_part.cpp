// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/measure/turns.h"
#include "bench/parts.h"
#include "bench/workload/random.h"
#include "hgrid_proximity/history/history.h"
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/world/scene.h"

namespace hgrid {
namespace bench {
namespace {

constexpr Time kPeriod = std::chrono::milliseconds(20);
constexpr int kTicks = 150;           // 3 s, so that the span of the history is filled and ticks are dropped
constexpr double kRoomPerBody = 1.0;  // [m^3]

/// Durations of one kind of call [us].
class Durations {
 public:
  template <class Call>
  void add(const Call& call) {
    const Clock::time_point begin = Clock::now();
    call();
    us_.push_back(1e3 * msSince(begin));
  }
  /// Returns the duration that a share of the calls did not exceed.
  double quantile(double share) {
    std::sort(us_.begin(), us_.end());
    return us_[std::min(us_.size() - 1, static_cast<std::size_t>(share * double(us_.size())))];
  }

 private:
  std::vector<double> us_;
};

/// Boxes of 0.1 to 0.3 m in a cube. Some of them move by up to 2 cm in each tick.
class Boxes {
 public:
  Boxes(std::size_t count, double moving) : random_(1), moving_(static_cast<std::size_t>(moving * double(count))) {
    side_ = std::cbrt(kRoomPerBody * double(count));
    for (std::size_t i = 0; i < count; ++i) {
      Body body;
      body.name = "obstacle/b" + std::to_string(i);
      body.frame = "world";
      const Shape box = Shape::box(Eigen::Vector3d::Constant(random_.uniform(0.1, 0.3)));
      body.shapes.push_back({box, Pose::Identity(), 0.0, std::string(), Eigen::Vector3d::Ones()});
      ids_.push_back(scene_.add(body));
      places_.push_back({random_.uniform(0, side_), random_.uniform(0, side_), random_.uniform(0, side_)});
      scene_.place(ids_[i], Pose(Eigen::Translation3d(places_[i])), stamp_);
    }
  }
  std::shared_ptr<const Snapshot> tick() {
    stamp_ += kPeriod;
    for (std::size_t i = 0; i < moving_; ++i) {
      for (int axis = 0; axis < 3; ++axis) places_[i][axis] += random_.uniform(-0.02, 0.02);
      scene_.place(ids_[i], Pose(Eigen::Translation3d(places_[i])), stamp_);
    }
    return scene_.commit(stamp_, {});
  }
  Sphere question() { return {{random_.uniform(0, side_), random_.uniform(0, side_), random_.uniform(0, side_)}, 0.5}; }
  Time back() { return kPeriod * (1 + static_cast<int>(random_.uniform(0, 99))); }

 private:
  Random random_;
  std::size_t moving_;
  Scene scene_{SceneOptions{}};
  double side_ = 0.0;
  Time stamp_{std::chrono::seconds(1)};
  std::vector<BodyId> ids_;
  std::vector<Eigen::Vector3d> places_;
};

Record play(std::size_t n, double moving) {
  Boxes boxes(n, moving);
  HistoryLimits limits;
  limits.bytes = std::size_t{4} << 30;
  History history(limits);
  Durations add, compact, first, again, now;
  std::shared_ptr<const Snapshot> newest;
  for (int i = 0; i < kTicks; ++i) {
    newest = boxes.tick();
    add.add([&] { history.add(newest); });
    compact.add([&] { history.compact(); });
  }
  const HistoryExtent extent = history.extent();
  std::size_t hits = 0;
  for (int i = 0; i < 100; ++i) {
    const Time stamp = newest->stamp() - boxes.back();
    const Sphere sphere = boxes.question();
    const auto ask = [&] { hits += query(*history.find(stamp, *newest).snapshot, sphere, {}).total; };
    first.add(ask);
    again.add(ask);
    now.add([&] { hits += query(*newest, sphere, {}).total; });
  }
  const double pairs = double(newest->pairs().size());
  std::printf(
      "  n = %-6zu moving %4.2f, %zu ticks, %.0f pairs: %.2f MB; add %.2f us (p99 %.2f), compact %.0f us; past "
      "query: first %.0f us (p99 %.0f), again %.2f us; query now %.2f us; %zu hits\n",
      n, moving, extent.ticks, pairs, 1e-6 * double(extent.bytes), add.quantile(0.5), add.quantile(0.99),
      compact.quantile(0.5), first.quantile(0.5), first.quantile(0.99), again.quantile(0.5), now.quantile(0.5), hits);
  std::fflush(stdout);
  Record record("history");
  record.number("n", double(n)).number("moving", moving).number("pairs", pairs);
  record.number("ticks", double(extent.ticks)).number("bytes", double(extent.bytes));
  record.number("add_us", add.quantile(0.5)).number("add_p99_us", add.quantile(0.99));
  record.number("compact_us", compact.quantile(0.5));
  record.number("first_us", first.quantile(0.5)).number("first_p99_us", first.quantile(0.99));
  record.number("again_us", again.quantile(0.5)).number("now_us", now.quantile(0.5));
  return record;
}

}  // namespace

void runHistory(const Options& options, std::vector<Record>& records) {
  std::vector<std::size_t> sizes{1000, 10000};
  if (options.quick) sizes.pop_back();
  if (!options.sizes.empty()) sizes = options.sizes;
  std::printf("\nhistory of 2 s at 50 Hz\n");
  for (const std::size_t n : sizes) {
    for (const double moving : {0.1, 1.0}) records.push_back(play(n, moving));
  }
}

}  // namespace bench
}  // namespace hgrid
