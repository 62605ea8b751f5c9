// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/edge_race.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kEdges = 200;     // edges of each kind
constexpr std::size_t kFineEdges = 20;  // edges that are also sampled each 1 mm
constexpr double kShort = 1.0;  // [rad] or [m] largest distance of the ends of half of the edges, in joint space
constexpr double kLong = 4.0;   // the same for the other half

/// Edges between states without contact.
struct Edges {
  std::vector<double> from, to;      // values of the group, edge after edge
  std::vector<std::size_t> samples;  // for each edge: number of parts that are 1 cm long
  std::size_t size() const { return samples.size(); }
};

std::vector<double> stateAt(const Edges& edges, std::size_t edge, std::size_t width, double at) {
  std::vector<double> state(width);
  for (std::size_t i = 0; i < width; ++i) {
    const double from = edges.from[edge * width + i];
    state[i] = from + at * (edges.to[edge * width + i] - from);
  }
  return state;
}

/// Returns the longest path of a corner of a shape's box on an edge [m].
double pathOf(const StateContest& contest, const Edges& edges, std::size_t edge) {
  constexpr int kSteps = 50;
  const std::size_t width = contest.robot.group.size();
  std::vector<double> paths;
  std::vector<Eigen::Vector3d> before;
  for (int step = 0; step <= kSteps; ++step) {
    std::vector<double> values = contest.batch.others;
    const std::vector<double> state = stateAt(edges, edge, width, double(step) / kSteps);
    for (std::size_t i = 0; i < width; ++i)
      values[std::size_t(contest.kinematics.find(contest.robot.group[i]))] = state[i];
    const std::vector<Pose> poses = contest.kinematics.rootFromLinks(values);
    std::vector<Eigen::Vector3d> corners;
    for (std::size_t link = 0; link < poses.size(); ++link) {
      for (const BodyShape& shape : contest.robot.model.links[link].shapes) {
        const Eigen::AlignedBox3d box = inDouble(boxOf(shape.shape, Pose::Identity(), 0.0, Eigen::Vector3d::Zero()));
        for (int i = 0; i < 8; ++i) {
          const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
          corners.push_back(poses[link] * (shape.body_from_shape * box.corner(corner)));
        }
      }
    }
    paths.resize(corners.size());
    for (std::size_t i = 0; step > 0 && i < corners.size(); ++i) paths[i] += (corners[i] - before[i]).norm();
    before = corners;
  }
  return *std::max_element(paths.begin(), paths.end());
}

/// Returns edges that begin at the states. Each ends on the way to another state.
Edges edgesFrom(const StateContest& contest, const std::vector<double>& states) {
  const std::size_t width = contest.robot.group.size(), count = states.size() / width;
  Edges edges;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    std::vector<double> way;
    double squared = 0.0;
    for (std::size_t k = 0; k < width; ++k) {
      const JointVariable& variable =
          contest.kinematics.variables()[std::size_t(contest.kinematics.find(contest.robot.group[k]))];
      way.push_back(states[(i + 1) * width + k] - states[i * width + k]);
      if (variable.is_angle && std::isinf(variable.lower)) way.back() = std::remainder(way.back(), 2.0 * M_PI);
      squared += way.back() * way.back();
    }
    const double part = std::min(1.0, (i % 2 == 0 ? kShort : kLong) / std::sqrt(squared));
    for (std::size_t k = 0; k < width; ++k) {
      edges.from.push_back(states[i * width + k]);
      edges.to.push_back(states[i * width + k] + part * way[k]);
    }
    edges.samples.push_back(1);
    edges.samples.back() = std::size_t(std::ceil(pathOf(contest, edges, i) / 0.01));
  }
  return edges;
}

/// Tests configurations of an edge in their order. Returns whether one of them is in contact.
bool sample(StateContest& contest, const Edges& edges, std::size_t edge, std::size_t parts) {
  const std::size_t width = contest.robot.group.size();
  std::vector<double> state(width);
  for (std::size_t i = 0; i <= parts; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      const double from = edges.from[edge * width + k];
      state[k] = from + double(i) / double(parts) * (edges.to[edge * width + k] - from);
    }
    if (contest.fcl->isInContact(state.data())) return true;
  }
  return false;
}

/// Numbers of edges for which both programs agree, or do not.
struct Agreement {
  std::size_t missed = 0;   // the samples miss a contact that FCL confirms
  std::size_t unknown = 0;  // hgrid: shapes pass each other within the tolerance
  std::size_t inside = 0;   // hgrid finds a contact that FCL does not confirm: a shape inside another
  std::size_t wrong = 0;    // hgrid says clear, and a sample is in contact
};

}  // namespace

void raceEdges(StateContest& contest, std::size_t boxes, const std::vector<double>& clear, int turns,
               std::vector<Record>& records) {
  const std::size_t width = contest.robot.group.size();
  const Edges all = edgesFrom(contest, clear);
  StateBatch batch = contest.batch;
  batch.positions.clear();
  std::vector<StateEdge> links;
  for (std::size_t i = 0; i < all.size(); ++i) {
    batch.positions.insert(batch.positions.end(), &all.from[i * width], &all.from[i * width] + width);
    batch.positions.insert(batch.positions.end(), &all.to[i * width], &all.to[i * width] + width);
    links.push_back({std::uint32_t(2 * i), std::uint32_t(2 * i + 1)});
  }
  EdgeAnswers answers;
  contest.checker->checkEdges(batch, links, {}, contest.scratch, answers);
  Agreement agreement;
  std::vector<std::size_t> kinds[2];  // clear, in contact
  for (std::size_t i = 0; i < all.size(); ++i) {
    const EdgeAnswer& answer = answers.edges[i];
    const bool sampled = sample(contest, all, i, all.samples[i]);
    if (answer.verdict == Verdict::clear && sampled) ++agreement.wrong;
    if (answer.verdict == Verdict::unknown) ++agreement.unknown;
    if (answer.verdict == Verdict::hit && !sampled) {
      const std::vector<double> state = stateAt(all, i, width, answer.at);
      ++(contest.fcl->isInContact(state.data()) ? agreement.missed : agreement.inside);
    }
    std::vector<std::size_t>& kind = kinds[answer.verdict == Verdict::hit ? 1 : 0];
    if (answer.verdict != Verdict::unknown && kind.size() < kEdges) kind.push_back(i);
  }
  std::printf("           edges: %zu; samples miss %zu contacts; hgrid: %zu unknown, %zu inside meshes, %zu wrong%s\n",
              all.size(), agreement.missed, agreement.unknown, agreement.inside, agreement.wrong,
              agreement.wrong == 0 ? "" : "  WRONG");
  for (const bool hit : {false, true}) {
    const std::vector<std::size_t>& kind = kinds[hit ? 1 : 0];
    if (kind.empty()) continue;
    std::vector<StateEdge> tested;
    double samples = 0.0;
    for (const std::size_t edge : kind) {
      tested.push_back(links[edge]);
      samples += double(all.samples[edge]) / double(kind.size());
    }
    EdgeRequest any;
    any.any_contact = true;
    std::vector<double> ours, ours_any, theirs, ratios, ratios_any;
    for (int turn = 0; turn < turns; ++turn) {
      double begin = threadTime();
      contest.checker->checkEdges(batch, tested, {}, contest.scratch, answers);
      ours.push_back((threadTime() - begin) / double(kind.size()));
      begin = threadTime();
      contest.checker->checkEdges(batch, tested, any, contest.scratch, answers);
      ours_any.push_back((threadTime() - begin) / double(kind.size()));
      begin = threadTime();
      for (const std::size_t edge : kind) sample(contest, all, edge, all.samples[edge]);
      theirs.push_back((threadTime() - begin) / double(kind.size()));
      ratios.push_back(theirs.back() / ours.back());
      ratios_any.push_back(theirs.back() / ours_any.back());
    }
    const std::size_t fine = std::min(kFineEdges, kind.size());
    const std::vector<StateEdge> few(tested.begin(), tested.begin() + std::ptrdiff_t(fine));
    double begin = threadTime();
    for (int turn = 0; turn < turns; ++turn) contest.checker->checkEdges(batch, few, {}, contest.scratch, answers);
    const double ours_fine = (threadTime() - begin) / turns;
    begin = threadTime();
    for (std::size_t i = 0; i < fine; ++i) sample(contest, all, kind[i], 10 * all.samples[kind[i]]);
    const double fine_ratio = (threadTime() - begin) / ours_fine;
    std::printf("           edges %-10s hgrid %7.1f us  FCL each 1 cm %8.1f us  %6.2f times;  each 1 mm %6.1f times",
                hit ? "in contact" : "clear", medianOf(ours), medianOf(theirs), medianOf(ratios), fine_ratio);
    if (hit) std::printf(";  any contact %6.1f us  %6.2f times", medianOf(ours_any), medianOf(ratios_any));
    std::printf("   (%zu edges of %.0f samples)\n", kind.size(), samples);
    std::fflush(stdout);
    Record record("edges");
    record.text("robot", contest.robot.name).number("boxes", double(boxes)).text("which", hit ? "in contact" : "clear");
    record.number("hgrid_us", medianOf(ours)).number("fcl_us", medianOf(theirs)).number("ratio", medianOf(ratios));
    record.number("any_us", medianOf(ours_any)).number("any_ratio", medianOf(ratios_any));
    record.number("ratio_1mm", fine_ratio).number("samples", samples).number("missed", double(agreement.missed));
    record.number("unknown", double(agreement.unknown)).number("edges", double(all.size()));
    records.push_back(record.number("wrong", double(agreement.wrong)).flag("correct", agreement.wrong == 0));
  }
}

}  // namespace bench
}  // namespace hgrid
