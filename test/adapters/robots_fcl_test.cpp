// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests UR5, Panda and PR2 in random states. Every pair that FCL finds within the margin must be a candidate pair.
// There may be at most four times as many candidate pairs. The environment variable HGRID_TEST_STATES sets the number
// of states.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>

#include "hgrid_proximity/adapters/srdf.h"
#include "test/adapters/fcl_witness.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

constexpr std::array<double, 2> kMargins = {0.05, 0.1};

/// The results for one margin.
struct Figures {
  std::size_t true_pairs = 0, candidates = 0, missed = 0;
  double ratio() const {
    return true_pairs == 0 ? 0.0 : static_cast<double>(candidates) / static_cast<double>(true_pairs);
  }
};

/// A robot in several Scenes, one for each margin, and a copy of its bodies for FCL.
class Trial {
 public:
  Trial(const RobotModel& model, const LinkRules& rules) {
    std::vector<std::string> warnings;
    const auto matrix = std::make_shared<const LinkMatrix>(model, rules, warnings);
    EXPECT_TRUE(warnings.empty()) << warnings.front();
    for (const double margin : kMargins) {
      SceneOptions options;
      options.margin = margin;
      scenes_.emplace_back(options);
      links_ = addLinks(scenes_.back(), model, matrix);
    }
    for (const auto& [link, id] : links_) bodies_.emplace_back(scenes_[0].body(id));
  }

  /// Compares one state of the robot and adds the result to `figures`.
  void compare(const std::vector<Pose>& root_from_links, Time stamp) {
    std::vector<std::shared_ptr<const Snapshot>> snapshots;
    for (Scene& scene : scenes_) {
      for (const auto& [link, id] : links_) {
        scene.place(id, root_from_links[link], stamp);
        scene.setState(id, Freshness::fresh, 0.0);
      }
      snapshots.push_back(scene.commit(stamp, {}));
      ASSERT_TRUE(snapshots.back()->complete()) << snapshots.back()->reasons().front();
    }
    std::array<std::map<std::pair<std::uint32_t, std::uint32_t>, double>, kMargins.size()> gaps;
    for (std::size_t m = 0; m < kMargins.size(); ++m) {
      for (const NearPair& pair : snapshots[m]->pairs()) gaps[m][{pair.first, pair.second}] = pair.gap;
      figures[m].candidates += gaps[m].size();
      EXPECT_EQ(gaps[m].size(), snapshots[m]->pairs().size()) << "a pair is listed twice";
    }
    const std::vector<std::uint32_t> index = indices(snapshots[0]->structure());
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto pair = std::minmax(index[i], index[j]);
        const bool allowed = snapshots[0]->structure().filter.allowed(pair.first, pair.second);
        const double distance = allowed ? kMargins.back() + 1.0 : distanceOf(i, j, root_from_links);
        for (std::size_t m = 0; m < kMargins.size(); ++m) {
          judge(figures[m], gaps[m], pair, allowed, distance, kMargins[m], snapshots[m]->structure());
        }
      }
    }
  }

  std::array<Figures, kMargins.size()> figures;

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  double distanceOf(std::size_t i, std::size_t j, const std::vector<Pose>& root_from_links) const {
    const double cutoff = kMargins.back() + 1e-3;
    return fclDistance(bodies_[i], root_from_links[links_[i].first], bodies_[j], root_from_links[links_[j].first],
                       cutoff);
  }

  /// Returns the index in the structure for each element of links_.
  std::vector<std::uint32_t> indices(const Structure& structure) const {
    std::vector<std::uint32_t> index;
    for (const auto& [link, id] : links_) {
      std::uint32_t at = 0;
      while (structure.bodies[at].link != link) ++at;
      index.push_back(at);
    }
    return index;
  }

  static void judge(Figures& figures, const std::map<Pair, double>& gaps, const Pair& pair, bool allowed,
                    double distance, double margin, const Structure& structure) {
    const auto found = gaps.find(pair);
    const std::string names = structure.bodies[pair.first].name + ", " + structure.bodies[pair.second].name;
    if (allowed) {
      EXPECT_TRUE(found == gaps.end()) << names << " may touch, but the pair is reported";
      return;
    }
    if (found != gaps.end()) {
      EXPECT_LE(found->second, margin) << names;
      EXPECT_LE(found->second, distance + 1e-7) << names << ": the gap must not exceed the distance";
    }
    if (distance > margin) return;
    ++figures.true_pairs;
    if (found != gaps.end()) return;
    ++figures.missed;
    if (figures.missed <= 10) ADD_FAILURE() << names << " are " << distance << " m apart, but the pair is missing";
  }

  std::vector<Scene> scenes_;
  std::vector<std::pair<std::uint32_t, BodyId>> links_;
  std::vector<FclBody> bodies_;  // one per element of links_
};

void expectNoMissedPair(const RealRobot& robot, const LinkRules& rules, const std::string& label, unsigned seed) {
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, robot.urdf);
  Trial trial(model, rules);
  RandomStates states(model, robot.urdf, seed);
  const int count = countFromEnvironment("HGRID_TEST_STATES", 1000);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", state " + std::to_string(i));
    trial.compare(states.next(), Time(i + 1));
    if (::testing::Test::HasFatalFailure()) return;
  }
  std::printf("  %-16s %7s %7s %11s %11s %6s %7s\n", "robot", "states", "margin", "true pairs", "candidates", "ratio",
              "missed");
  for (std::size_t m = 0; m < kMargins.size(); ++m) {
    const Figures& f = trial.figures[m];
    std::printf("  %-16s %7d %7.2f %11zu %11zu %6.2f %7zu\n", label.c_str(), count, kMargins[m], f.true_pairs,
                f.candidates, f.ratio(), f.missed);
    EXPECT_EQ(f.missed, 0u);
    EXPECT_GT(f.true_pairs, 0u);
    EXPECT_TRUE(f.candidates <= 4 * f.true_pairs || count < 1000);  // for few states, the ratio has no meaning
  }
}

class RobotsAgainstFcl : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { HGRID_NEEDS_SHARED_DATA(); }
};

TEST_P(RobotsAgainstFcl, CandidatesHoldEveryPairWithinTheMargin) {
  const RealRobot robot = realRobot(GetParam());
  expectNoMissedPair(robot, readSrdf(robot.srdf), robot.name, 1);
}

TEST_P(RobotsAgainstFcl, CandidatesHoldEveryPairWithoutAnSrdfToo) {
  const RealRobot robot = realRobot(GetParam());
  expectNoMissedPair(robot, LinkRules{}, robot.name + ", no SRDF", 2);
}

INSTANTIATE_TEST_SUITE_P(Real, RobotsAgainstFcl, ::testing::Values("ur5", "panda", "pr2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace test
}  // namespace hgrid
