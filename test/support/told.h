// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/world/snapshot.h"
#include "test/support/events.h"

namespace hgrid {
namespace test {

inline std::string bytes(const void* data, std::size_t size) {
  return std::string(static_cast<const char*>(data), size);
}

/// The content of a snapshot as texts and bytes. It does not include the revision of the structure, because equal
/// snapshots may have different revisions.
struct Told {
  std::string numbers, bodies, poses, ages, boxes, pairs, grid, answers;
  std::vector<std::string> events, reasons;
};

inline std::string numbersOf(const Snapshot& s) {
  return "sequence " + std::to_string(s.sequence()) + ", epoch " + std::to_string(s.epoch()) + ", stamp " +
         std::to_string(s.stamp().count()) + ", last event " + std::to_string(s.lastEvent()) + ", reasons " +
         std::to_string(s.reasonsTotal()) + ", worst " + name(s.worstState());
}

inline std::string pairsOf(const Snapshot& s) {
  std::string text;
  for (const NearPair& pair : s.pairs()) {
    text += s.structure().bodies[pair.first].name + " " + s.structure().bodies[pair.second].name + " " +
            std::to_string(pair.gap) + " " + std::to_string(pair.margin) + " since " +
            std::to_string(pair.since.count()) + " flags " + std::to_string(pair.flags) + "\n";
  }
  for (std::uint32_t body = 0; s.rooms() != nullptr && body < s.poses().size(); ++body) {
    for (const std::uint32_t room : s.rooms()->roomsOf(body)) text += std::to_string(room) + ",";
    text += s.rooms()->isAnywhere(body) ? "*;" : ";";
  }
  return text;
}

inline std::string gridOf(const Snapshot& s) {
  s.broadPhase().checkInvariants();
  std::vector<ProxyPair> pairs;
  s.broadPhase().overlappingPairs(pairs);
  std::sort(pairs.begin(), pairs.end());
  return bytes(pairs.data(), pairs.size() * sizeof(ProxyPair));
}

inline std::string answersOf(const Snapshot& s) {
  std::string text;
  const Sphere sphere{{0, 0, 0}, 1.0};
  const Segment segment{{-3, -3, -3}, {3, 3, 3}, 0.1};
  for (const QueryAnswer& answer :
       {query(s, sphere, {}), query(s, segment, {}), nearest(s, Eigen::Vector3d(1, 1, 1), 5, {})}) {
    text += "verdict " + std::to_string(int(answer.verdict)) + "\n";
    for (const QueryHit& hit : answer.hits) {
      text += std::to_string(hit.body) + " " + std::to_string(hit.distance) + "\n";
    }
  }
  return text;
}

inline Told tell(const Snapshot& s) {
  Told told;
  told.numbers = numbersOf(s);
  for (std::uint32_t i = 0; i < s.poses().size(); ++i) {
    const BodyPose& pose = s.poses()[i];
    told.bodies += s.structure().bodies[i].name + "\n";
    told.poses += bytes(pose.world_from_body.data(), 16 * sizeof(double)) + name(pose.state);
    told.ages += bytes(&pose.stamp, sizeof(Time)) + std::to_string(pose.age) + std::to_string(pose.growth);
    const bool placed = pose.state != Freshness::unplaced;
    const std::uint32_t first = s.structure().first_proxy[i], last = s.structure().first_proxy[i + 1];
    if (placed) told.boxes += bytes(s.boxes().data() + first, (last - first) * sizeof(Aabb));
  }
  told.pairs = pairsOf(s);
  told.grid = gridOf(s);
  told.answers = answersOf(s);
  told.events = test::eventsOf(s);
  told.reasons = s.reasons();
  return told;
}

/// Expects equal contents. Does not compare the ages and stamps of poses.
inline void expectEqual(const Told& told, const Told& expected) {
  ASSERT_EQ(told.numbers, expected.numbers);
  ASSERT_EQ(told.bodies, expected.bodies);
  ASSERT_TRUE(told.poses == expected.poses);
  ASSERT_TRUE(told.boxes == expected.boxes);
  ASSERT_EQ(told.pairs, expected.pairs);
  ASSERT_EQ(told.events, expected.events);
  ASSERT_EQ(told.reasons, expected.reasons);
  ASSERT_TRUE(told.grid == expected.grid);
  ASSERT_EQ(told.answers, expected.answers);
}

}  // namespace test
}  // namespace hgrid
