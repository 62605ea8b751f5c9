// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/broadphase/hgrid/loose_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "src/broadphase/hgrid/found_boxes.h"
#include "test/support/random.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;
using test::randomVector;

/// Boxes in a table, and the same boxes in a map, which the answers are compared with.
class BothTables {
 public:
  explicit BothTables(double finest_edge) : table_(finest_edge) {}

  const LooseBoxes& table() const { return table_; }
  const std::map<ProxyId, Aabb>& boxes() const { return boxes_; }

  void add(ProxyId id, const Aabb& box) {
    table_.reserve(box);
    if (!table_.hasRoom(box)) return;
    place_[id] = table_.add(id, box);
    boxes_[id] = box;
  }
  /// Moves a box if it may stay on its level.
  void move(ProxyId id, const Aabb& box) {
    if (table_.move(place_.at(id), box)) boxes_[id] = box;
  }
  void remove(ProxyId id) {
    const std::uint32_t place = place_.at(id);
    if (table_.remove(place)) place_[table_.idAt(place)] = place;
    place_.erase(id);
    boxes_.erase(id);
  }
  void expectSameBoxes() const {
    table_.checkInvariants();
    ASSERT_EQ(table_.size(), boxes_.size());
    for (const auto& one : boxes_)
      ASSERT_TRUE(table_.idAt(place_.at(one.first)) == one.first && table_.boxAt(place_.at(one.first)) == one.second);
  }
  void expectSameAnswer(const Aabb& query) const {
    std::vector<ProxyId> expected;
    for (const auto& one : boxes_) {
      if (overlap(one.second, query)) expected.push_back(one.first);
    }
    PositionWriter writer;
    table_.overlapping(boxOf(query), writer.sink());
    ASSERT_EQ(idsOf(writer), expected);
  }
  /// The table may name boxes that the segment misses, but each of them once.
  void expectSameAnswer(const Segment& segment) const {
    std::vector<ProxyId> expected;
    const FirstTouch firstTouch(segment);
    for (const auto& one : boxes_) {
      if (firstTouch(one.second)) expected.push_back(one.first);
    }
    PositionWriter writer;
    table_.along(lineOf(segment), writer.sink());
    const std::vector<ProxyId> found = idsOf(writer);
    ASSERT_TRUE(std::adjacent_find(found.begin(), found.end()) == found.end()) << "a box was found twice";
    ASSERT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
  }

 private:
  std::vector<ProxyId> idsOf(const PositionWriter& writer) const {
    std::vector<ProxyId> ids;
    for (const std::uint32_t place : writer) ids.push_back(table_.idAt(place));
    std::sort(ids.begin(), ids.end());
    return ids;
  }

  LooseBoxes table_;
  std::map<ProxyId, Aabb> boxes_;
  std::map<ProxyId, std::uint32_t> place_;
};

/// A box of any size near one of a few places, of which some are far away.
Aabb anyBox(Random& random) {
  const double far = random.chance(0.1) ? 1e6 : 1.0, size = std::pow(10.0, random.uniform(-6, 2));
  return test::boxAround(far * randomVector(random, -10, 10),
                         randomVector(random, 0, 1) * (random.chance(0.1) ? 0.0 : size));
}

/// Claim: after any changes, the table answers as a list of all boxes would, for queries that cover few cells and for
/// those that cover more cells than there are boxes.
TEST(LooseBoxes, FindWhatAListOfThemFinds) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Random random(seed);
    BothTables both(std::ldexp(1.0, random.below(12) - 8));
    ProxyId next = 0;
    for (int i = 0; i < 600; ++i) {
      const std::size_t count = both.table().size();
      if (count == 0 || random.chance(0.5)) {
        both.add(next++, anyBox(random));
      } else if (random.chance(0.6)) {
        const auto one = std::next(both.boxes().begin(), random.below(static_cast<int>(count)));
        const Eigen::Vector3d by = randomVector(random, -2, 2);
        both.move(one->first, random.chance(0.5)
                                  ? anyBox(random)
                                  : Aabb{one->second.min + by.cast<float>(), one->second.max + by.cast<float>()});
      } else {
        both.remove(std::next(both.boxes().begin(), random.below(static_cast<int>(count)))->first);
      }
      if (i % 20 == 0) both.expectSameBoxes();
      both.expectSameAnswer(anyBox(random));
      Segment segment;
      segment.from = anyBox(random).min.cast<double>();
      segment.to = random.chance(0.1) ? segment.from : Eigen::Vector3d(anyBox(random).max.cast<double>());
      segment.radius = random.chance(0.5) ? 0.0 : std::pow(10.0, random.uniform(-4, 1));
      both.expectSameAnswer(segment);
    }
    ASSERT_FALSE(both.boxes().empty());
  }
}

/// Claim: a bucket takes only so many boxes, whatever their coordinates.
TEST(LooseBoxes, HaveNoRoomForManyBoxesInOneCell) {
  LooseBoxes table(1.0);
  const Aabb box = test::boxAround({0.1, 0.2, 0.3}, {0.5, 0.5, 0.5});
  ProxyId id = 0;
  for (; id < 1000; ++id) {
    table.reserve(box);
    if (!table.hasRoom(box)) break;
    table.add(id, box);
  }
  EXPECT_EQ(id, 64u);
  EXPECT_TRUE(table.hasRoom(test::boxAround({100.0, 0.0, 0.0}, {0.5, 0.5, 0.5})));
  table.clear();
  EXPECT_TRUE(table.hasRoom(box));
}

TEST(LooseBoxes, HoldTheLongestAndTheFarthestBoxes) {
  BothTables both(0x1p-30);  // the longest boxes are beyond the last level
  constexpr float kMost = std::numeric_limits<float>::max();
  both.add(1, {{-kMost, -kMost, -kMost}, {kMost, kMost, kMost}});
  both.add(2, {{kMost, kMost, kMost}, {kMost, kMost, kMost}});
  both.add(3, {{0, 0, 0}, {0, 0, 0}});
  both.add(4, {{-kMost, 0, 0}, {0, 0, 0}});
  both.expectSameBoxes();
  for (const auto& one : both.boxes()) both.expectSameAnswer(one.second);
  Segment segment;
  segment.to = Eigen::Vector3d(1e30, 1e30, 1e30);
  both.expectSameAnswer(segment);
}

}  // namespace
}  // namespace hgrid
