// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Plans a motion of a robot through a map with RRT-Connect (Kuffner and LaValle, 2000). StateChecker proves that each
// edge of the plan is free. The plan is printed with three decimals; the proof is for the values before rounding.
// Space that the map does not know counts as free. Uses the library without ROS.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/adapters/mesh.h"
#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "hgrid_proximity/world/scene.h"

namespace {

using State = std::vector<double>;  // one value for each variable of the robot

constexpr char kUsage[] =
    "usage: plan_alone [--srdf FILE] [--packages FOLDER --mesh-reader PROGRAM] [--at X Y Z] FILE.urdf FILE.bt START... "
    ": "
    "GOAL...\n\n"
    "Plans a motion of a robot through a map, proves that it is free, and prints it.\n\n"
    "  -h, --help             print this text and end\n"
    "  --srdf FILE            SRDF file that says which pairs of links may touch\n"
    "  --packages FOLDER      folder that contains the ROS packages with the meshes of the robot\n"
    "  --mesh-reader PROGRAM  path of the program proximity_mesh_reader, which reads these meshes\n"
    "  --at X Y Z             position of the root link in the frame of the map [m]; default: 0 0 0\n"
    "  START, GOAL            one value for each joint variable [rad or m], separated by spaces. If their number is\n"
    "                         wrong, the program prints the names of the variables in their order.\n"
    "exit codes: 0 a free motion was found; 1 none was found, or a file cannot be read; 2 wrong arguments\n";

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

hgrid::RobotModel readRobot(const std::string& urdf, const std::string& packages, const std::string& mesh_reader) {
  hgrid::MeshPolicy policy;
  policy.reader = mesh_reader;
  policy.resources.package_path = [packages](const std::string& package) { return packages + "/" + package; };
  hgrid::MeshLoader loader(policy);
  return hgrid::readUrdf(textOf(urdf),
                         [&](const std::string& uri, const Eigen::Vector3d& scale) { return loader.load(uri, scale); });
}

/// Adds each link that has collision shapes. All poses here are placeholders: StateChecker computes the poses of the
/// links from StateBatch::world_from_root and the joint values.
void addRobot(hgrid::Scene& scene, hgrid::NarrowPhase& narrow, const hgrid::RobotModel& model,
              const hgrid::LinkRules& rules) {
  std::vector<std::string> warnings;
  const auto matrix = std::make_shared<const hgrid::LinkMatrix>(model, rules, warnings);
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].hasGeometry()) continue;
    hgrid::Body body = hgrid::linkBody(model, i, "robot", matrix);  // if a shape could not be read, no state is CLEAR
    for (hgrid::BodyShape& shape : body.shapes) shape.solid = narrow.solidOf(shape.shape);
    scene.place(scene.add(std::move(body)), hgrid::Pose::Identity(), hgrid::Time{1});
  }
}

void addMap(hgrid::Scene& scene, const hgrid::NarrowPhase& narrow, const std::string& path) {
  const hgrid::Octomap map = hgrid::readOctomap(textOf(path), "the map");
  hgrid::Body body;
  body.name = "map/map";
  body.kind = hgrid::BodyKind::map;
  body.mobility = hgrid::Mobility::fixed;
  const hgrid::BodyId id = scene.add(body);
  scene.place(id, hgrid::Pose::Identity(), hgrid::Time{1});
  scene.setCells(id, hgrid::makeMapCells(std::make_shared<hgrid::StaticGrid>(map.resolution, map.occupied), narrow));
}

/// Plans between two states. A tree grows from each of them.
class Planner {
 public:
  Planner(const hgrid::StateChecker& checker, const hgrid::Pose& world_from_root)
      : checker_(checker), dimensions_(checker.kinematics().variables().size()) {
    batch_.world_from_root = world_from_root;
    request_.any_contact = true;
  }
  int edges() const { return edges_; }  // how many edges were checked

  /// Returns the states of a free way; empty: none was found.
  std::vector<State> plan(const State& start, const State& goal, int tries) {
    Tree trees[2] = {{{start, 0}}, {{goal, 0}}};
    for (int turn = 0; turn < tries; ++turn) {
      Tree &one = trees[turn % 2], &other = trees[1 - turn % 2];
      extend(one, randomState());
      if (!extend(other, one.back().state)) continue;
      std::vector<State> way = toRoot(trees[0]), rest = toRoot(trees[1]);
      std::vector<State> whole(way.rbegin(), way.rend());
      whole.insert(whole.end(), rest.begin() + 1, rest.end());
      return whole;
    }
    return {};
  }

 private:
  struct Node {
    State state;
    std::size_t parent;  // index of the node before it; the root is its own parent
  };
  using Tree = std::vector<Node>;

  /// Adds edges from the node that is nearest to `target` toward `target`, until an edge is not free. Returns whether
  /// the tree reached `target`.
  bool extend(Tree& tree, const State& target) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < tree.size(); ++i) {
      if (apart(tree[i].state, target) < apart(tree[nearest].state, target)) nearest = i;
    }
    constexpr double kStep = 1.0;  // largest length of an edge in joint space [rad, or m for prismatic joints]
    while (true) {
      const State& from = tree[nearest].state;
      const double length = apart(from, target), part = length > kStep ? kStep / length : 1.0;
      State to = from;
      for (std::size_t i = 0; i < dimensions_; ++i) to[i] += part * (target[i] - from[i]);
      if (!isFree(from, to)) return false;
      tree.push_back({to, nearest});
      nearest = tree.size() - 1;
      if (length <= kStep) return true;
    }
  }

  bool isFree(const State& from, const State& to) {
    batch_.positions = from;
    batch_.positions.insert(batch_.positions.end(), to.begin(), to.end());
    checker_.checkEdges(batch_, {{0, 1}}, request_, scratch_, answers_);
    ++edges_;
    const hgrid::EdgeAnswer& edge = answers_.edges.front();
    return edge.verdict == hgrid::Verdict::clear && !edge.beyond_limits;
  }

  State randomState() {
    State state;  // a joint without limits: about one turn
    for (const hgrid::JointVariable& variable : checker_.kinematics().variables()) {
      const double low = std::isfinite(variable.lower) ? variable.lower : -3.1;
      const double high = std::isfinite(variable.upper) ? variable.upper : 3.1;
      state.push_back(low + (high - low) * static_cast<double>(random_()) / 4294967296.0);
    }
    return state;
  }

  static double apart(const State& a, const State& b) {
    double squared = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) squared += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(squared);
  }

  /// Returns the states from the last node of a tree to its root.
  static std::vector<State> toRoot(const Tree& tree) {
    std::vector<State> way{tree.back().state};
    for (std::size_t node = tree.size() - 1; node != tree[node].parent;) {
      node = tree[node].parent;
      way.push_back(tree[node].state);
    }
    return way;
  }

  const hgrid::StateChecker& checker_;
  const std::size_t dimensions_;
  hgrid::StateBatch batch_;
  hgrid::EdgeRequest request_;
  hgrid::StateScratch scratch_;
  hgrid::EdgeAnswers answers_;
  std::mt19937 random_{1};  // fixed seed, so that the plan is reproducible
  int edges_ = 0;
};

/// Returns whether a state is free. If not, prints the reason. @param name  "start" or "goal"
bool checkEnd(const char* name, const hgrid::StateChecker& checker, const hgrid::Pose& world_from_root,
              const State& state) {
  hgrid::StateBatch batch;
  batch.positions = state;
  batch.world_from_root = world_from_root;
  hgrid::StateScratch scratch;
  hgrid::StateAnswers answers;
  checker.checkStates(batch, {}, scratch, answers);
  if (answers.states.front().verdict == hgrid::Verdict::clear) return true;
  std::printf("the %s is not free: ", name);
  if (answers.pairs.empty()) {
    std::printf("%s\n", checker.sentenceOf(batch, answers, 0).c_str());
  } else {
    const hgrid::BodyList& bodies = checker.snapshot().structure().bodies;
    std::printf("%s touches %s\n", bodies[answers.pairs[0].first].name.c_str(),
                bodies[answers.pairs[0].second].name.c_str());
  }
  return false;
}

struct Arguments {
  bool help = false;
  std::map<std::string, std::string> options;
  std::vector<std::string> files;
  hgrid::Pose world_from_root = hgrid::Pose::Identity();
  State start, goal;
};

/// Reads the command line. @throws std::logic_error if it is not as kUsage says
/// @throws std::runtime_error with one sentence if an option is unknown
Arguments read(std::vector<std::string> words) {
  Arguments arguments;
  std::size_t i = 0;
  for (; i < words.size() && words[i].rfind("-", 0) == 0; ++i) {
    if (words[i] == "--help" || words[i] == "-h") {
      arguments.help = true;
      return arguments;
    }
    if (words[i] == "--at") {
      for (int axis = 0; axis < 3; ++axis) arguments.world_from_root.translation()[axis] = std::stod(words.at(++i));
    } else if (words[i] == "--srdf" || words[i] == "--packages" || words[i] == "--mesh-reader") {
      const std::string name = words[i];
      arguments.options[name] = words.at(++i);
    } else {
      throw std::runtime_error("the option " + words[i] + " is unknown; --help lists all options");
    }
  }
  for (int file = 0; file < 2; ++file) arguments.files.push_back(words.at(i++));
  for (; words.at(i) != ":"; ++i) arguments.start.push_back(std::stod(words[i]));
  for (++i; i < words.size(); ++i) arguments.goal.push_back(std::stod(words[i]));
  return arguments;
}

int plan(Arguments& arguments) {
  const hgrid::RobotModel model =
      readRobot(arguments.files[0], arguments.options["--packages"], arguments.options["--mesh-reader"]);
  const std::string srdf = arguments.options["--srdf"];
  const std::shared_ptr<hgrid::NarrowPhase> narrow = hgrid::makeCoreNarrowPhase();
  hgrid::Scene scene{hgrid::SceneOptions{}};
  addRobot(scene, *narrow, model, srdf.empty() ? hgrid::LinkRules{} : hgrid::readSrdf(textOf(srdf)));
  addMap(scene, *narrow, arguments.files[1]);
  const hgrid::Kinematics kinematics(model);
  const hgrid::StateChecker checker(scene.commit(hgrid::Time{1}, {}), kinematics, "robot", narrow);
  if (arguments.start.size() != kinematics.variables().size() || arguments.goal.size() != arguments.start.size()) {
    std::printf("start and goal have %zu and %zu values; each must have %zu:", arguments.start.size(),
                arguments.goal.size(), kinematics.variables().size());
    for (const hgrid::JointVariable& variable : kinematics.variables()) std::printf(" %s", variable.name.c_str());
    std::printf("\n");
    return 2;
  }
  if (!checkEnd("start", checker, arguments.world_from_root, arguments.start)) return 1;
  if (!checkEnd("goal", checker, arguments.world_from_root, arguments.goal)) return 1;
  Planner planner(checker, arguments.world_from_root);
  const std::vector<State> way = planner.plan(arguments.start, arguments.goal, 3000);
  if (way.empty()) return std::printf("no free way was found; %d edges were checked\n", planner.edges()), 1;
  std::printf("a free way of %zu states; %d edges were checked\n", way.size(), planner.edges());
  for (const State& state : way) {
    for (const double value : state) std::printf(" %7.3f", value);
    std::printf("\n");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  try {
    arguments = read({argv + 1, argv + argc});
  } catch (const std::runtime_error& error) {
    return std::fprintf(stderr, "plan_alone: %s\n", error.what()), 2;
  } catch (const std::logic_error&) {
    return std::fputs(kUsage, stderr), 2;
  }
  if (arguments.help) return std::fputs(kUsage, stdout), 0;
  try {
    return plan(arguments);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "plan_alone: %s\n", error.what()), 1;
  }
}
