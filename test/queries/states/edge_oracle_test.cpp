// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares edges with an oracle that measures all shapes in many configurations of each edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "test/queries/states/edge_worlds.h"

namespace hgrid {
namespace {

using namespace test;

/// Numbers of edges of each kind, so that the test can show that it has looked at all of them.
struct Seen {
  int edges = 0, hits = 0, clear = 0, close = 0;
};

/// Returns the smallest distance near a configuration where the samples of an edge have a minimum [m].
double refined(const StateOracle& oracle, const EdgeOracle& edge, const Pose& root, double low, double high) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 20; ++i) {
    const double third = (high - low) / 3.0;
    const double a = oracle.of(edge.at(low + third), root).distance,
                 b = oracle.of(edge.at(high - third), root).distance;
    least = std::min({least, a, b});
    (a < b ? high : low) = a < b ? high - third : low + third;
  }
  return least;
}

void compare(StateOracle& oracle, const EdgeOracle& edge, const Pose& root, const EdgeAnswers& answers, std::size_t i,
             Seen& seen) {
  constexpr int kSamples = 80;
  const EdgeAnswer& answer = answers.edges[i];
  std::vector<double> distances;
  for (int k = 0; k <= kSamples; ++k) {
    const double at = double(k) / kSamples;
    distances.push_back(oracle.of(edge.at(at), root).distance);
    ASSERT_TRUE(at >= answer.free_until || distances.back() > 0.0) << "at " << at << " of " << answer.free_until;
  }
  ++seen.edges;
  if (answer.verdict == Verdict::clear) {
    ++seen.clear;
    EXPECT_EQ(answer.free_until, 1.0);
    for (int k = 1; k < kSamples; ++k) {
      const auto n = std::size_t(k);
      if (distances[n] > 0.05 || distances[n] > distances[n - 1] || distances[n] > distances[n + 1]) continue;
      EXPECT_GT(refined(oracle, edge, root, double(k - 1) / kSamples, double(k + 1) / kSamples), 0.0) << k;
    }
  } else if (answer.verdict == Verdict::hit) {
    ++seen.hits;
    oracle.surfaces_only = false;
    const Truth truth = oracle.of(edge.at(answer.at), root);
    ASSERT_EQ(answer.pairs, 1u);
    const StatePair& pair = answers.pairs[answer.first_pair];
    EXPECT_EQ(truth.contacts.count(std::minmax(pair.first, pair.second)), 1u) << answer.at;
    EXPECT_LE(answer.free_until, answer.at);
    oracle.expectContact(pair, edge.at(answer.at), root);
    oracle.surfaces_only = true;
  } else if (answer.because != Unknown::half_turn) {
    ++seen.close;
    EXPECT_EQ(answer.because, Unknown::tolerance);
    EXPECT_LT(oracle.of(edge.at(answer.free_until), root).distance, 2e-3);
    for (const double distance : distances) EXPECT_GT(distance, 0.0) << "a contact as long as this must be found";
  }
}

TEST(EdgeOracle, NoClearEdgeHasAContactAndEachHitIsOne) {
  const int count = countFromEnvironment("HGRID_TEST_CHECKED_EDGES", 600);
  Seen seen;
  for (unsigned seed = 1; seen.edges < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = random.between(2, 7);
    plan.obstacles = random.chance(0.5) ? random.between(0, 4) : random.between(8, 26);
    plan.far = 1.5;
    plan.map = random.chance(0.3);
    plan.world_from_root = randomPose(random, 1.0);
    const StateWorld world = randomStateWorld(random, plan);
    const StateChecker checker = world.checker();
    if (checker.kinematics().variables().empty()) continue;
    const RandomEdges edges(random, checker, world.model, 12);
    StateScratch scratch;
    EdgeAnswers answers;
    EdgeRequest first;
    first.contacts = true;
    checker.checkEdges(edges.batch, edges.edges, first, scratch, answers);
    EdgeRequest any;
    any.contacts = true;
    any.any_contact = true;
    EdgeAnswers others;
    checker.checkEdges(edges.batch, edges.edges, any, scratch, others);
    StateOracle oracle(world);
    oracle.surfaces_only = true;
    for (std::size_t i = 0; i < edges.edges.size(); ++i) {
      SCOPED_TRACE("edge " + std::to_string(i));
      compare(oracle, edges.oracle(i), plan.world_from_root, answers, i, seen);
      EdgeAnswers alone;
      checker.checkEdges(edges.batch, {edges.edges[i]}, {}, scratch, alone);
      EXPECT_EQ(alone.edges[0].verdict, answers.edges[i].verdict) << "an answer does not depend on other edges";
      EXPECT_EQ(alone.edges[0].free_until, answers.edges[i].free_until);
      EXPECT_TRUE(alone.edges[0].at == answers.edges[i].at || std::isnan(alone.edges[0].at));
      // A tested configuration may be in a contact that is shorter than the tolerance.
      EXPECT_TRUE(others.edges[i].verdict == answers.edges[i].verdict ||
                  (others.edges[i].verdict == Verdict::hit && answers.edges[i].verdict == Verdict::unknown))
          << "with any contact instead of the first one";
      if (others.edges[i].verdict == Verdict::hit) {
        oracle.surfaces_only = false;
        const StatePair& pair = others.pairs[others.edges[i].first_pair];
        const Truth truth = oracle.of(edges.oracle(i).at(others.edges[i].at), plan.world_from_root);
        EXPECT_EQ(truth.contacts.count(std::minmax(pair.first, pair.second)), 1u) << others.edges[i].at;
        oracle.expectContact(pair, edges.oracle(i).at(others.edges[i].at), plan.world_from_root);
        oracle.surfaces_only = true;
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(seen.hits, seen.edges / 10);
  EXPECT_GT(seen.clear, seen.edges / 10);
}

/// Returns the length of the longest path of the origin of a shape on an edge [m].
double longestPath(const EdgeOracle& edge, const StateWorld& world) {
  constexpr int kParts = 32;  // parts of the edge for measuring the paths
  std::vector<double> paths;
  std::vector<Eigen::Vector3d> last;
  for (int part = 0; part <= kParts; ++part) {
    const JointOracle joints(world.model, world.kinematics(), edge.at(double(part) / kParts));
    std::size_t count = 0;
    for (std::size_t link = 0; link < world.model.links.size(); ++link) {
      const Pose root_from_link = joints.rootFromLink(int(link));
      for (const BodyShape& shape : world.model.links[link].shapes) {
        const Eigen::Vector3d center = root_from_link * shape.body_from_shape.translation();
        if (part == 0) {
          paths.push_back(0.0);
          last.push_back(center);
        }
        paths[count] += (center - last[count]).norm();
        last[count++] = center;
      }
    }
  }
  return *std::max_element(paths.begin(), paths.end());
}

/// Returns whether equally spaced configurations of an edge miss every contact. The origin of each shape moves at most
/// about 1 cm per step, on average.
bool isMissedBySamples(const EdgeOracle& edge, const StateWorld& world) {
  const int samples = int(std::ceil(longestPath(edge, world) / 0.01)) + 1;
  StateBatch batch;
  for (int i = 0; i <= samples; ++i) append(batch, edge.at(double(i) / samples));
  StateScratch scratch;
  StateAnswers answers;
  world.checker().checkStates(batch, {}, scratch, answers);
  return std::none_of(answers.states.begin(), answers.states.end(),
                      [](const StateAnswer& answer) { return answer.verdict == Verdict::hit; });
}

/// Claim: what is in the way is never missed, however thin it is. The obstacle is put where a point of the robot is at
/// some configuration of the edge, so that the truth is known.
TEST(EdgeOracle, AThinPlateOrWireInTheWayIsNeverMissed) {
  const int count = countFromEnvironment("HGRID_TEST_PLATES", 10000);
  int tried = 0, hits = 0, missed = 0;
  for (unsigned seed = 1; tried < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = random.between(2, 6);
    plan.obstacles = 0;
    plan.attached = plan.map = plan.plane = false;
    StateWorld world = randomStateWorld(random, plan);
    if (world.kinematics().variables().empty()) continue;
    const RandomEdges edges(random, world.checker(), world.model, 8);
    for (std::size_t i = 0; i < edges.edges.size(); ++i) {
      SCOPED_TRACE("edge " + std::to_string(i));
      const double at = random.uniform(0, 1);
      const JointOracle joints(world.model, world.kinematics(), edges.oracle(i).at(at));
      const int link = random.below(plan.links);
      if (world.model.links[std::size_t(link)].shapes.empty()) continue;
      Body thin = obstacle("thin", Mobility::fixed);
      const bool is_wire = random.chance(0.5);
      thin.shapes = {solidShape(Shape::box({1e-3, is_wire ? 1e-3 : 0.2, 0.3}))};
      Pose pose = randomPose(random, 0.0);
      pose.translation() =
          (joints.rootFromLink(link) * world.model.links[std::size_t(link)].shapes[0].body_from_shape).translation();
      const BodyId id = put(*world.scene, thin, pose);
      world.snapshot = world.scene->commit(Time{2}, {});
      StateOracle oracle(world);
      oracle.surfaces_only = true;
      if (!oracle.of(edges.oracle(i).at(at), Pose::Identity()).contacts.empty()) {
        StateScratch scratch;
        EdgeAnswers answers;
        world.checker().checkEdges(edges.batch, {edges.edges[i]}, {}, scratch, answers);
        ++tried;
        hits += answers.edges[0].verdict == Verdict::hit ? 1 : 0;
        ASSERT_NE(answers.edges[0].verdict, Verdict::clear);
        ASSERT_LE(answers.edges[0].free_until, at);
        missed += isMissedBySamples(edges.oracle(i), world) ? 1 : 0;
      }
      world.scene->remove(id);
    }
  }
  EXPECT_GT(hits, tried * 9 / 10);
  std::printf("samples each 1 cm miss %d of %d contacts; checkEdges() misses none\n", missed, tried);
}

}  // namespace
}  // namespace hgrid
