// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// make_srdf: writes the pairs of links that may touch into an SRDF. kUsage says more.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgrid_proximity/adapters/mesh.h"
#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/bodies/link_matrix.h"
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/explain/allowed_matrix.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "hgrid_proximity/world/scene.h"
#include "node/params/mesh_policy.h"
#include "node/params/params.h"

namespace hgrid {
namespace {

constexpr char kUsage[] =
    "usage: rosrun hgrid_proximity make_srdf [--states N] [FILE] > ROBOT.srdf\n\n"
    "Reads a URDF from a file, or from standard input, and writes an SRDF with the pairs of links that may touch:\n\n"
    "- adjacent links,\n"
    "- pairs that touch in all of N random states of the joints within their limits,\n"
    "- pairs that touch in none of them, unless a planar or floating joint or an endless slide moves them apart.\n\n"
    "Each line has its reason. What touches in some states only stays switched on. Needs no ROS master and ignores "
    "ROS\n"
    "remappings. Meshes are found as in the node: package:// by ROS_PACKAGE_PATH.\n\n"
    "options:\n"
    "  --states N  number of states, 100 to 1000000; 10000 by default\n"
    "  -h, --help  print this text and end\n\n"
    "exit codes:\n"
    "  0  the SRDF was written\n"
    "  1  the URDF or one of its shapes cannot be read, or its states cannot be checked\n"
    "  2  an argument is wrong, or the file cannot be read\n";

using Pair = std::pair<std::uint32_t, std::uint32_t>;  // two links, the smaller index first

/// Checks random states of a robot that is alone in the world.
class Sampling {
 public:
  /// @throws Refusal if a link has a shape that cannot be read, or if states of the robot cannot be checked
  explicit Sampling(RobotModel& model) : model_(model), kinematics_(model), narrow_phase_(makeCoreNarrowPhase()) {
    std::vector<std::string> warnings;
    matrix_ = std::make_shared<const LinkMatrix>(model, LinkRules{}, warnings);
    Scene scene{SceneOptions{}};
    for (std::uint32_t i = 0; i < model.links.size(); ++i) {
      RobotLink& link = model.links[i];
      if (!link.unreadable.empty()) throw link.unreadable.front();
      if (link.shapes.empty()) continue;
      for (BodyShape& shape : link.shapes) shape.solid = narrow_phase_->solidOf(shape.shape);
      scene.place(scene.add(linkBody(model, i, "robot", matrix_)), Pose::Identity(), Time{1});
    }
    snapshot_ = scene.commit(Time{1}, {});
  }

  const LinkMatrix& matrix() const { return *matrix_; }

  /// Returns in how many of `states` random states each pair that is not adjacent or rigid touches.
  std::map<Pair, std::size_t> contacts(std::size_t states) {
    constexpr std::size_t kAtOnce = 1000;
    std::map<Pair, std::size_t> counts;
    const StateChecker checker(snapshot_, kinematics_, "robot", narrow_phase_);
    StateRequest request;
    request.all_pairs = true;
    StateScratch scratch;
    StateAnswers answers;
    for (std::size_t done = 0; done < states; done += kAtOnce) {
      StateBatch batch;
      batch.world_from_root = Pose::Identity();
      for (std::size_t i = 0; i < std::min(kAtOnce, states - done); ++i) appendState(batch.positions);
      checker.checkStates(batch, request, scratch, answers);
      for (std::size_t i = 0; i < answers.states.size(); ++i) {
        if (answers.states[i].verdict == Verdict::unknown)
          throw std::runtime_error("a state cannot be checked: " + checker.sentenceOf(batch, answers, i));
      }
      for (const StatePair& pair : answers.pairs) ++counts[linksOf(pair)];
    }
    return counts;
  }

 private:
  void appendState(std::vector<double>& positions) {
    for (const JointVariable& variable : kinematics_.variables()) {
      if (variable.quaternion >= 0) {  // of a floating joint; pairs that it moves stay on
        positions.push_back(variable.name.substr(variable.name.size() - 1) == "w" ? 1.0 : 0.0);
        continue;
      }
      const bool limited = std::isfinite(variable.lower) && std::isfinite(variable.upper) &&
                           !(variable.is_angle && variable.upper - variable.lower > 2.0 * M_PI);
      const double low = limited ? variable.lower : variable.is_angle ? -M_PI : -1.0;
      const double high = limited ? variable.upper : variable.is_angle ? M_PI : 1.0;
      // The generator gives the same numbers everywhere; the distributions of the standard library do not.
      positions.push_back(low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53));
    }
  }
  Pair linksOf(const StatePair& pair) const {
    const std::uint32_t first = snapshot_->structure().bodies[pair.first].link,
                        second = snapshot_->structure().bodies[pair.second].link;
    return std::minmax(first, second);
  }

  RobotModel& model_;
  Kinematics kinematics_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  std::shared_ptr<const LinkMatrix> matrix_;
  std::shared_ptr<const Snapshot> snapshot_;
  std::mt19937_64 random_{1};
};

/// Returns for each link the joints above it that can carry it any distance, by the index of their child links.
std::vector<std::vector<std::uint32_t>> endlessJoints(const RobotModel& model) {
  std::vector<std::vector<std::uint32_t>> above(model.links.size());
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    const RobotLink& link = model.links[i];
    if (link.parent < 0) continue;
    above[i] = above[static_cast<std::size_t>(link.parent)];
    const bool free = link.joint_kind == JointKind::planar || link.joint_kind == JointKind::floating;
    const bool endless = link.joint_kind == JointKind::prismatic && link.lower == 0.0 && link.upper == 0.0;
    if (free || endless) above[i].push_back(i);
  }
  return above;
}

/// Returns why a pair of links may touch, as MoveIt's assistant says it; empty: it may not.
/// @param reached  whether random states reach all places where the two links can be relative to each other
std::string reasonOf(Origin origin, std::size_t contacts, std::size_t states, bool reached) {
  if (origin == Origin::adjacent) return "Adjacent";
  if (origin != Origin::none) return "";  // links of one rigid group: they need no rule
  if (!reached) return "";
  if (contacts == 0) return "Never in " + std::to_string(states) + " states";
  return contacts == states ? "Always in " + std::to_string(states) + " states" : "";
}

/// Writes the SRDF to standard output, and a summary to standard error.
void write(RobotModel& model, std::size_t states) {
  Sampling sampling(model);
  const std::map<Pair, std::size_t> contacts = sampling.contacts(states);
  std::printf("<?xml version=\"1.0\"?>\n<robot name=\"%s\">\n", xmlEscaped(model.name).c_str());
  const std::vector<std::vector<std::uint32_t>> endless = endlessJoints(model);
  std::size_t on = 0, off = 0;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    for (std::uint32_t j = i + 1; j < model.links.size(); ++j) {
      if (model.links[i].shapes.empty() || model.links[j].shapes.empty()) continue;
      const auto found = contacts.find({i, j});
      const Origin origin = sampling.matrix().origin(i, j);
      const std::string reason =
          reasonOf(origin, found == contacts.end() ? 0 : found->second, states, endless[i] == endless[j]);
      if (reason.empty()) {
        on += origin == Origin::none;
        continue;
      }
      ++off;
      std::printf("  <disable_collisions link1=\"%s\" link2=\"%s\" reason=\"%s\"/>\n",
                  xmlEscaped(model.links[i].name).c_str(), xmlEscaped(model.links[j].name).c_str(), reason.c_str());
    }
  }
  std::printf("</robot>\n");
  std::fprintf(stderr, "%zu pairs of links may touch, %zu others stay on\n", off, on);
}

int run(const std::string& file, std::size_t states) {
  std::ifstream opened;
  if (!file.empty()) opened.open(file, std::ios::binary);
  std::istream& in = file.empty() ? std::cin : opened;
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in && text.empty()) {
    std::fprintf(stderr, "the file '%s' cannot be read\n", file.c_str());
    return 2;
  }
  try {
    MeshLoader meshes(meshPolicy(Params(), nullptr));
    RobotModel model =
        readUrdf(text, [&](const std::string& uri, const Eigen::Vector3d& scale) { return meshes.load(uri, scale); });
    for (const std::string& warning : model.warnings) std::fprintf(stderr, "%s\n", warning.c_str());
    write(model, states);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace
}  // namespace hgrid

int main(int argc, char** argv) {
  std::string file;
  std::size_t states = 10000;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h") return std::fputs(hgrid::kUsage, stdout), 0;
    if (word.find(":=") != std::string::npos) continue;
    if (word == "--states" && i + 1 < argc) {
      states = std::strtoul(argv[++i], nullptr, 10);
    } else if (word.rfind('-', 0) != 0 && file.empty()) {
      file = word;
      continue;
    } else {
      states = 0;
    }
    if (states >= 100 && states <= 1000000) continue;
    std::fputs("make_srdf: the arguments are [--states N] [FILE], with N from 100 to 1000000; --help says more\n",
               stderr);
    return 2;
  }
  return hgrid::run(file, states);
}
