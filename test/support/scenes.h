// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "test/support/bodies.h"
#include "test/support/oracle.h"
#include "test/support/shapes.h"

namespace hgrid {
namespace test {

/// Returns a random multiple of 1/64 between `low` and `high`. Sums of such numbers are exact in every order.
inline double sixtyFourths(Random& random, double low, double high) {
  return std::floor(random.uniform(low, high) * 64.0) / 64.0;
}

inline Body obstacle(const std::string& name, Mobility mobility = Mobility::moving) {
  Body body;
  body.name = "obstacle/" + name;
  body.frame = "world";
  body.mobility = mobility;
  return body;
}

inline Body ball(const std::string& name, double radius = 0.5, Mobility mobility = Mobility::moving) {
  Body body = obstacle(name, mobility);
  body.shapes.push_back(shapeOf(Shape::sphere(radius)));
  return body;
}

/// Returns a fixed obstacle that is a plane.
inline Body planeBody(const std::string& name, double padding = 0.0) {
  Body body = obstacle(name, Mobility::fixed);
  body.shapes.push_back(shapeOf(Shape::plane()));
  body.shapes.back().padding = padding;
  return body;
}

inline Pose at(double x, double y = 0, double z = 0) {
  Pose pose = Pose::Identity();
  pose.translation() << x, y, z;
  return pose;
}

/// Adds a body, places it, and sets its state to FRESH.
inline BodyId put(Scene& scene, const Body& body, const Pose& pose, Time stamp = Time{1}) {
  const BodyId id = scene.add(body);
  scene.place(id, pose, stamp);
  scene.setState(id, Freshness::fresh, 0.0);
  return id;
}

/// Returns a random body of one to four shapes. Some bodies have padding or a margin of their own, and some are fixed.
inline Body randomBody(Random& random, const std::string& name) {
  Body body = obstacle(name, random.chance(0.2) ? Mobility::fixed : Mobility::moving);
  for (int i = random.between(1, 4); i > 0; --i) {
    BodyShape shape = shapeOf(randomShape(random, random.chance(0.1) ? 3.0 : 0.5));
    shape.body_from_shape = randomPose(random, 0.5);
    if (random.chance(0.3)) shape.padding = random.uniform(0, 0.2);
    body.shapes.push_back(shape);
  }
  if (random.chance(0.3)) body.margin = sixtyFourths(random, 0, 1);
  body.max_speed = random.chance(0.3) ? std::numeric_limits<double>::infinity() : sixtyFourths(random, 0, 2);
  return body;
}

inline BodyId putRandom(Scene& scene, Random& random, const std::string& name, double far = 3.0) {
  return put(scene, randomBody(random, name), randomPose(random, far));
}

/// Returns the index of the body `name` in a snapshot. Fails the test if there is none.
inline std::uint32_t indexOf(const Snapshot& snapshot, const std::string& name) {
  const BodyList& bodies = snapshot.structure().bodies;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].name == name) return i;
  }
  ADD_FAILURE() << "there is no body with the name " << name;
  return 0;
}

using NamePairs = std::set<std::pair<std::string, std::string>>;

inline NamePairs namedPairs(const Snapshot& snapshot) {
  NamePairs pairs;
  const BodyList& bodies = snapshot.structure().bodies;
  for (const NearPair& pair : snapshot.pairs()) pairs.emplace(bodies[pair.first].name, bodies[pair.second].name);
  return pairs;
}

inline bool contains(const NamePairs& larger, const NamePairs& smaller) {
  return std::includes(larger.begin(), larger.end(), smaller.begin(), smaller.end());
}

/// Returns whether a pair filter without rules reports the pair of bodies. Computes it without the product's filter.
inline bool reported(const Body& a, const Body& b) {
  if (a.kind == BodyKind::link && b.kind == BodyKind::link && a.robot == b.robot) {
    return a.links->origin(a.link, b.link) == Origin::none;
  }
  return a.mobility == Mobility::moving || b.mobility == Mobility::moving;
}

/// Expects that the snapshot contains exactly the pairs whose boxes are within the documented margin, and that their
/// gaps are right. Finds the pairs by brute force over all shapes.
inline void expectPairsOfTheOracle(const Snapshot& snapshot, double global_margin) {
  const Structure& structure = snapshot.structure();
  const std::vector<Aabb>& boxes = snapshot.boxes();
  std::size_t next = 0;
  for (std::uint32_t i = 0; i < structure.bodies.size(); ++i) {
    for (std::uint32_t j = i + 1; j < structure.bodies.size(); ++j) {
      const Body &a = structure.bodies[i], &b = structure.bodies[j];
      const BodyPose &p = snapshot.poses()[i], &q = snapshot.poses()[j];
      if (p.state == Freshness::unplaced || q.state == Freshness::unplaced || !reported(a, b)) continue;
      const bool equally_old = p.cohort != 0 && p.cohort == q.cohort && !a.robot.empty() && a.robot == b.robot;
      const double margin = std::max({global_margin, a.margin, b.margin}) + (equally_old ? 0.0 : p.growth + q.growth);
      bool near = false;
      double gap = std::numeric_limits<double>::infinity();
      for (std::uint32_t k = structure.first_proxy[i]; k < structure.first_proxy[i + 1]; ++k) {
        for (std::uint32_t l = structure.first_proxy[j]; l < structure.first_proxy[j + 1]; ++l) {
          near = near || oracleWithin(boxes[k], boxes[l], margin);
          double sum = 0;
          for (int axis = 0; axis < 3; ++axis) {
            const double apart = std::max({0.0, double(boxes[k].min[axis]) - boxes[l].max[axis],
                                           double(boxes[l].min[axis]) - boxes[k].max[axis]});
            sum += apart * apart;
          }
          gap = std::min(gap, std::sqrt(sum));
        }
      }
      if (!near) continue;
      SCOPED_TRACE(a.name + " and " + b.name);
      ASSERT_LT(next, snapshot.pairs().size()) << "a pair is missing";
      const NearPair& pair = snapshot.pairs()[next++];
      ASSERT_EQ(pair.first, i) << "a pair is missing or out of order";
      ASSERT_EQ(pair.second, j) << "a pair is missing or out of order";
      ASSERT_DOUBLE_EQ(pair.gap, gap);
      ASSERT_LE(pair.gap, pair.margin);
      ASSERT_EQ(pair.margin, margin);
    }
  }
  ASSERT_EQ(next, snapshot.pairs().size()) << "the snapshot has pairs that are too far apart";
}

}  // namespace test
}  // namespace hgrid
