// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares the pairs and distances of robots with robots.hash. Every system must give the same numbers to 1e-9,
// whatever its versions of urdfdom, FCL, Eigen and the C library are. After a deliberate change of the answers,
// write the hash that the failed test prints into robots.hash.
#include <gtest/gtest.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/distances/pair_meter.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

constexpr double kNear = 0.1;  // [m]
constexpr int kRandomStates = 50;

/// A robot at a fixed place. Its joints move.
class PlacedRobot {
 public:
  PlacedRobot(const RealRobot& texts, const Pose& world_from_root, Scene& scene, NarrowPhase& narrow_phase)
      : world_from_root_(world_from_root),
        loader_(meshPolicy()),
        model_(readWith(loader_, texts.urdf)),
        states_(model_, texts.urdf, 11) {
    std::vector<std::string> warnings;
    const LinkRules rules = texts.srdf.empty() ? LinkRules{} : readSrdf(texts.srdf);
    const auto matrix = std::make_shared<const LinkMatrix>(model_, rules, warnings);
    links_ = addLinks(scene, model_, matrix, &narrow_phase, texts.name);
  }

  void moveTo(Time stamp, Scene& scene) {
    const std::vector<Pose> root_from_links = states_.next();
    for (const auto& [link, id] : links_) {
      scene.place(id, world_from_root_ * root_from_links[link], stamp);
      scene.setState(id, Freshness::fresh, 0.0);
    }
  }

 private:
  Pose world_from_root_;
  MeshLoader loader_;
  RobotModel model_;
  RandomStates states_;  // refers to model_
  std::vector<std::pair<std::uint32_t, BodyId>> links_;
};

/// Returns a number in billionths. The C library rounds sin() and cos() differently on processors without fused
/// multiply-add, which changes answers by up to 1e-15.
std::string text(double number) {
  return std::isnan(number) ? " nan" : " " + std::to_string(std::llround(1e9 * number));
}

/// Returns a line for each near pair: names and gap. Then a line for each measured pair: names, status, distance and
/// depth. Nearest points are left out: FCL finds those of a cylinder by iteration, and its versions 0.6.1 (Debian 11)
/// and 0.7.0 (Debian 12) stop up to 2e-6 m from each other, at the same distance.
std::string linesOf(const Snapshot& snapshot, const PairDistances& distances) {
  const BodyList& bodies = snapshot.structure().bodies;
  const auto names = [&](const auto& pair) { return bodies[pair.first].name + " " + bodies[pair.second].name + " "; };
  std::string lines;
  for (const NearPair& pair : snapshot.pairs()) lines += names(pair) + "near" + text(pair.gap) + "\n";
  for (const PairDistance& pair : distances.pairs) {
    const Proximity& measured = pair.proximity;
    lines += names(pair) + name(measured.status) + text(measured.distance) + text(measured.depth) + "\n";
  }
  return lines;
}

struct Place {
  RealRobot texts;
  Pose world_from_root;
};

/// Returns the pairs and distances of the robots in random states with a fixed seed.
std::string answersOf(const std::vector<Place>& places) {
  SceneOptions options;
  options.margin = kNear;
  Scene scene(options);
  const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  PairMeter meter(narrow_phase, {kNear, 0.0, 1});
  std::vector<std::unique_ptr<PlacedRobot>> robots;
  for (const Place& place : places) {
    robots.push_back(std::make_unique<PlacedRobot>(place.texts, place.world_from_root, scene, *narrow_phase));
  }
  std::string lines;
  for (int state = 1; state <= kRandomStates; ++state) {
    for (const auto& robot : robots) robot->moveTo(Time{state}, scene);
    const std::shared_ptr<const Snapshot> snapshot = scene.commit(Time{state}, {});
    lines += "state " + std::to_string(state) + "\n" + linesOf(*snapshot, *meter.measure(*snapshot));
  }
  return lines;
}

/// Returns the robots of the demo cell. The mobile base stands in front of the table.
std::vector<Place> demoCell() {
  const std::string demo = std::string(HGRID_PROJECT_DIR) + "/demo/";
  const std::string arm = fileText(demo + "six_axis_arm.urdf"), rules = fileText(demo + "six_axis_arm.srdf");
  const auto at = [](double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); };
  Pose turned = at(0.60, 0.0, 0.75);
  turned.linear().diagonal() << -1.0, -1.0, 1.0;
  return {{{"left_arm", arm, rules}, at(-0.60, 0.0, 0.75)},
          {{"right_arm", arm, rules}, turned},
          {{"conveyor", fileText(demo + "conveyor.urdf"), ""}, at(0.0, 0.75, 0.0)},
          {{"mobile_base", fileText(demo + "mobile_base.urdf"), ""}, at(0.0, -0.7, 0.0)}};
}

/// The 64-bit FNV-1a hash of a text, as text.
std::string hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const unsigned char byte : text) hash = (hash ^ byte) * 0x100000001b3u;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016" PRIx64, hash);
  return digits;
}

/// Returns the hash of a robot in robots.hash.
std::string expectedHash(const std::string& robot) {
  std::istringstream file(fileText(std::string(HGRID_PROJECT_DIR) + "/test/adapters/robots.hash"));
  std::string name, hash;
  while (file >> name >> hash) {
    if (name == robot) return hash;
  }
  return "";
}

class RobotsAnswers : public ::testing::TestWithParam<const char*> {};

TEST_P(RobotsAnswers, AreTheSameOnEverySystem) {
  const std::string robot = GetParam();
  if (robot != "demo") HGRID_NEEDS_SHARED_DATA();
  const std::string answers =
      answersOf(robot == "demo" ? demoCell() : std::vector<Place>{{realRobot(robot), Pose::Identity()}});
  const std::string path = ::testing::TempDir() + robot + ".answers";
  if (hashOf(answers) != expectedHash(robot)) std::ofstream(path) << answers;
  EXPECT_EQ(hashOf(answers), expectedHash(robot))
      << "the answers are in " << path << "; compare this file with the file "
      << "of a system whose answers are right";
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotsAnswers, ::testing::Values("demo", "ur5", "panda", "pr2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace test
}  // namespace hgrid
