// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Measures UR5, Panda and PR2 in random states. The exact distances must equal the distances that FCL measures for
// every pair without a broad phase. Also prints the time, and the time of FCL's DynamicAABBTree. The environment
// variable HGRID_TEST_STATES sets the number of states.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "test/adapters/fcl_tree.h"
#include "test/adapters/fcl_witness.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kReport = 0.1;  // [m] greatest distance that is reported

double median(std::vector<double>& values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// A robot whose distances are measured in three ways: by a PairMeter, by FCL for every pair, and by FCL's tree.
class Trial {
 public:
  Trial(const RobotModel& model, const LinkRules& rules)
      : scene_([] {
          SceneOptions options;
          options.margin = kReport;
          return options;
        }()),
        meter_(narrow_phase_, {kReport, 0.0, 1}) {
    std::vector<std::string> warnings;
    const auto matrix = std::make_shared<const LinkMatrix>(model, rules, warnings);
    links_ = addLinks(scene_, model, matrix, narrow_phase_.get());
    for (const auto& [link, id] : links_) {
      witnesses_.emplace_back(scene_.body(id));
      tree_.add(scene_.body(id));
    }
  }

  void compare(const std::vector<Pose>& root_from_links, Time stamp) {
    if (stamp.count() % 2 == 0) askTree(root_from_links);  // the two orders alternate, for a fair comparison of times
    const std::shared_ptr<const PairDistances> found = measure(root_from_links, stamp);
    if (stamp.count() % 2 != 0) askTree(root_from_links);
    std::map<std::pair<std::uint32_t, std::uint32_t>, const PairDistance*> ours;
    for (const PairDistance& pair : found->pairs) ours[{pair.first, pair.second}] = &pair;
    ASSERT_EQ(ours.size(), found->pairs.size()) << "a pair is listed twice";
    ASSERT_EQ(found->left_out, 0u);
    const Structure& structure = snapshot_->structure();
    for (std::size_t i = 0; i < links_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto numbers = std::minmax(index_[i], index_[j]);
        const auto entry = ours.find({numbers.first, numbers.second});
        const PairDistance* mine = entry == ours.end() ? nullptr : entry->second;
        const std::string names = structure.bodies[numbers.first].name + ", " + structure.bodies[numbers.second].name;
        if (allowed(i, j)) {
          EXPECT_EQ(mine, nullptr) << names;
          continue;
        }
        const double expected = fclDistance(witnesses_[i], root_from_links[links_[i].first], witnesses_[j],
                                            root_from_links[links_[j].first], kReport + 1e-3);
        judge(names, mine, expected);
      }
    }
  }

  double largest_error = 0.0;
  std::size_t pairs = 0, tree_pairs = 0, contacts = 0, enclosed = 0;
  std::vector<double> ours_ms, tree_ms;

 private:
  bool allowed(std::size_t i, std::size_t j) const { return allowed_[i * links_.size() + j]; }

  std::shared_ptr<const PairDistances> measure(const std::vector<Pose>& root_from_links, Time stamp) {
    const Clock::time_point begin = Clock::now();
    for (const auto& [link, id] : links_) {
      scene_.place(id, root_from_links[link], stamp);
      scene_.setState(id, Freshness::fresh, 0.0);
    }
    snapshot_ = scene_.commit(stamp, {});
    const std::shared_ptr<const PairDistances> found = meter_.measure(*snapshot_);
    ours_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    return found;
  }

  void askTree(const std::vector<Pose>& root_from_links) {
    if (!snapshot_) snapshot_ = scene_.commit(Time{1}, {});
    if (index_.empty()) {
      const Structure& structure = snapshot_->structure();
      for (const auto& [link, id] : links_) index_.push_back(structure.find(scene_.body(id).name));
      for (const std::uint32_t i : index_) {
        for (const std::uint32_t j : index_)
          allowed_.push_back(structure.filter.allowed(std::min(i, j), std::max(i, j)));
      }
    }
    std::vector<Pose> poses;
    for (const auto& [link, id] : links_) poses.push_back(root_from_links[link]);
    const Clock::time_point begin = Clock::now();
    tree_pairs += tree_.distances(poses, kReport, [this](std::size_t i, std::size_t j) { return allowed(i, j); });
    tree_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }

  void judge(const std::string& names, const PairDistance* mine, double expected) {
    if (mine == nullptr) {
      EXPECT_GT(expected, kReport - 1e-6) << names << " are " << expected << " m apart, but the pair is missing";
      return;
    }
    const Proximity& proximity = mine->proximity;
    ASSERT_NE(proximity.status, Measure::failed) << names;
    ASSERT_NE(proximity.status, Measure::not_measured) << names;
    ++pairs;
    contacts += proximity.status == Measure::contact;
    if (proximity.status == Measure::contained || proximity.status == Measure::containment_unknown) {
      ++enclosed;  // FCL treats a mesh as a surface, so its distance is not comparable
      EXPECT_GT(expected, 0.0) << names;
      return;
    }
    EXPECT_LE(mine->gap, proximity.distance + 1e-7) << names << ": the gap must not exceed the distance";
    EXPECT_NEAR(proximity.distance, expected, 1e-6) << names;
    if (proximity.distance > 0.0) {
      EXPECT_NEAR((proximity.on_first - proximity.on_second).norm(), proximity.distance, 1e-6) << names;
    }
    largest_error = std::max(largest_error, std::abs(proximity.distance - expected));
  }

  std::shared_ptr<NarrowPhase> narrow_phase_ = makeCoreNarrowPhase();
  Scene scene_;
  PairMeter meter_;
  std::vector<std::pair<std::uint32_t, BodyId>> links_;
  std::vector<FclBody> witnesses_;  // one per element of links_
  FclTree tree_;                    // its bodies are in the same order as links_
  std::shared_ptr<const Snapshot> snapshot_;
  std::vector<std::uint32_t> index_;  // index of the body in the structure, for each element of links_
  std::vector<bool> allowed_;         // whether a pair is allowed, for each pair of indices in links_
};

class RobotsDistances : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { HGRID_NEEDS_SHARED_DATA(); }
};

TEST_P(RobotsDistances, EqualThoseOfFclForEveryPair) {
  const RealRobot robot = realRobot(GetParam());
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, robot.urdf);
  Trial trial(model, readSrdf(robot.srdf));
  RandomStates states(model, robot.urdf, 3);
  const int count = countFromEnvironment("HGRID_TEST_STATES", 1000);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("seed 3, state " + std::to_string(i));
    trial.compare(states.next(), Time(i + 1));
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(trial.pairs, 0u);
  const double ours = median(trial.ours_ms), tree = median(trial.tree_ms);
  std::printf("  %-6s %5d states: %zu pairs within %.1f m, %zu in contact, %zu enclosed; largest error %.1e m\n",
              robot.name.c_str(), count, trial.pairs, kReport, trial.contacts, trial.enclosed, trial.largest_error);
  std::printf("  %-6s median %.3f ms per state; FCL's DynamicAABBTree with a bounded callback %.3f ms (%.1f times)\n",
              robot.name.c_str(), ours, tree, tree / ours);
}

INSTANTIATE_TEST_SUITE_P(Real, RobotsDistances, ::testing::Values("ur5", "panda", "pr2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace test
}  // namespace hgrid
