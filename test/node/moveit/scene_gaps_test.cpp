// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/moveit/scene_gaps.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

using Kind = ObstacleChange::Kind;
using Lack = SceneGaps::Lack;

ObstacleChanges changes(Kind kind, const std::vector<std::string>& names) {
  ObstacleChanges all;
  for (const std::string& name : names) {
    all.changes.emplace_back();
    all.changes.back().kind = kind;
    all.changes.back().name = name;
  }
  return all;
}

ObstacleChanges completeScene(bool spare_attached = false) {
  ObstacleChanges all;
  all.complete_set_of = "moveit";
  all.spare_attached = spare_attached;
  return all;
}

bool says(const SceneGaps& gaps, const std::string& part) {
  return gaps.sentence() && gaps.sentence()->find(part) != std::string::npos;
}

TEST(SceneGapsTest, EndWhenEachObjectWasAddedOrRemoved) {
  SceneGaps gaps;
  EXPECT_FALSE(gaps.sentence());
  gaps.noteRefused({{"obstacle/a", Lack::shapes}, {"obstacle/b", Lack::shapes}, {"obstacle/c", Lack::shapes}},
                   "its shape is flat");
  EXPECT_TRUE(says(gaps, "its shape is flat"));
  EXPECT_TRUE(says(gaps, "REFUSED 3 objects"));
  gaps.noteApplied(changes(Kind::add, {"obstacle/a", "obstacle/d"}));
  gaps.noteApplied(changes(Kind::remove, {"obstacle/b"}));
  EXPECT_TRUE(says(gaps, "'obstacle/c'"));
  gaps.noteRemoved("obstacle/c");
  EXPECT_FALSE(gaps.sentence());
}

TEST(SceneGapsTest, DoNotStoreNamesThatNoObstacleCanHave) {
  SceneGaps gaps;
  const std::string name = "obstacle/" + std::string(1000000, 'x');
  gaps.noteRefused({{name, Lack::shapes}}, "its name is too long");
  EXPECT_TRUE(says(gaps, "its name is too long"));
  EXPECT_FALSE(says(gaps, "xxx"));
  gaps.noteRemoved(name);
  EXPECT_TRUE(gaps.sentence()) << "nobody can remove it by its name";
  gaps.noteApplied(completeScene());
  EXPECT_FALSE(gaps.sentence());
}

TEST(SceneGapsTest, OfShapesDoNotEndWhenTheObjectMoves) {
  for (const Kind kind : {Kind::append, Kind::move, Kind::attach, Kind::detach}) {
    SceneGaps gaps;
    gaps.noteRefused({{"obstacle/a", Lack::shapes}}, "why");
    gaps.noteApplied(changes(kind, {"obstacle/a"}));
    EXPECT_TRUE(gaps.sentence()) << static_cast<int>(kind);
  }
}

TEST(SceneGapsTest, OfAPlaceEndWhenTheObjectHasAPlace) {
  for (const Kind kind : {Kind::add, Kind::remove, Kind::move, Kind::attach, Kind::detach}) {
    SceneGaps gaps;
    gaps.noteRefused({{"obstacle/a", Lack::place}}, "why");
    gaps.noteApplied(changes(kind, {"obstacle/a"}));
    EXPECT_FALSE(gaps.sentence()) << static_cast<int>(kind);
    gaps.noteRefused({{"obstacle/a", Lack::place}}, "why");
    gaps.noteRefused({{"obstacle/a", Lack::shapes}}, "why");
    gaps.noteApplied(changes(Kind::move, {"obstacle/a"}));
    EXPECT_TRUE(gaps.sentence()) << "the worse lack counts";
  }
}

TEST(SceneGapsTest, OfUnknownObjectsEndWithACompleteScene) {
  SceneGaps gaps;
  gaps.noteRefused({{"", Lack::shapes}}, "it is cut off");
  gaps.noteApplied(changes(Kind::add, {"obstacle/a"}));
  gaps.noteApplied(changes(Kind::remove_all_free, {""}));
  EXPECT_TRUE(gaps.sentence());
  gaps.noteApplied(completeScene(true));
  EXPECT_TRUE(gaps.sentence()) << "it may be an attached object, and the scene says nothing about them";
  gaps.noteApplied(completeScene());
  EXPECT_FALSE(gaps.sentence());
}

TEST(SceneGapsTest, OfAttachedObjectsStayIfACompleteSceneSparesThem) {
  SceneGaps gaps;
  gaps.noteRefused({{"obstacle/held", Lack::place}, {"obstacle/free", Lack::shapes}}, "why");
  gaps.noteApplied(completeScene(true));
  EXPECT_TRUE(says(gaps, "REFUSED 1 object of"));
  gaps.noteApplied(completeScene());
  EXPECT_FALSE(gaps.sentence());
}

// Claim: what a message does to a free object says nothing about an object of the same name that MoveIt has attached.
TEST(SceneGapsTest, OfAttachedObjectsDoNotEndWithFreeObjects) {
  for (const Lack lack : {Lack::shapes, Lack::place}) {
    SceneGaps gaps;
    gaps.noteRefused({{"obstacle/held", lack, true}}, "why");
    ObstacleChanges free_one = changes(Kind::add, {"obstacle/held"});
    free_one.changes[0].free_only = true;
    gaps.noteApplied(free_one);
    for (const Kind kind : {Kind::remove, Kind::move, Kind::remove_all_free})
      gaps.noteApplied(changes(kind, {"obstacle/held"}));
    gaps.noteApplied(completeScene(true));
    gaps.noteRemoved("obstacle/held");
    EXPECT_TRUE(gaps.sentence());
    SceneGaps detached = gaps;
    gaps.noteApplied(changes(Kind::add, {"obstacle/held"}));
    gaps.noteApplied(changes(Kind::attach, {"obstacle/held"}));
    EXPECT_FALSE(gaps.sentence());
    detached.noteDetached("obstacle/held");
    EXPECT_TRUE(detached.sentence()) << "now it is a free object of MoveIt";
    detached.noteRemoved("obstacle/held");
    EXPECT_FALSE(detached.sentence());
  }
}

TEST(SceneGapsTest, BeyondTheLimitStayUntilACompleteScene) {
  SceneGaps gaps;
  std::vector<std::string> names;
  std::vector<SceneGaps::Object> objects;
  for (std::size_t i = 0; i <= SceneGaps::kMostNames; ++i) {
    names.push_back("obstacle/" + std::to_string(i));
    objects.push_back({names.back(), Lack::shapes});
  }
  gaps.noteRefused(objects, "why");
  gaps.noteApplied(changes(Kind::add, names));
  EXPECT_TRUE(gaps.sentence()) << "one name was not stored";
  gaps.noteApplied(completeScene());
  EXPECT_FALSE(gaps.sentence());
}

}  // namespace
}  // namespace hgrid
