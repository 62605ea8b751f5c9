// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/missing_sources.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

std::vector<std::string> namesOf(const MissingSources& missing) {
  std::vector<SourceGap> gaps;
  missing.appendGaps(gaps);
  std::vector<std::string> names;
  for (const SourceGap& gap : gaps) names.push_back(gap.source);
  return names;
}

Params cell() {
  Params params;
  params.maps.emplace_back();
  params.maps.back().name = "hall";
  params.clouds.push_back({"eye"});
  params.trackers.emplace_back();
  params.trackers.back().name = "people";
  return params;
}

TEST(MissingSources, AreAtFirstAllConfiguredMapsCloudsAndTrackers) {
  MissingSources missing(cell());
  EXPECT_EQ(namesOf(missing), (std::vector<std::string>{"cloud/eye", "map/hall", "track/people"}));
  missing.set(SourceId::ofRobot("arm"), "NOT_READY");
  EXPECT_EQ(namesOf(missing), (std::vector<std::string>{"arm", "cloud/eye", "map/hall", "track/people"}));
  EXPECT_TRUE(missing.has(SourceId::ofRobot("arm")));
  EXPECT_FALSE(missing.has(SourceId::ofRobot("hall")));
}

TEST(MissingSources, HaveTheNewestSentence) {
  MissingSources missing(cell());
  missing.set(SourceId::ofRobot("arm"), "PARSE robot 'arm': broken");
  std::vector<SourceGap> gaps(1);
  missing.appendGaps(gaps);
  ASSERT_EQ(gaps.size(), 5u) << "appendGaps() keeps earlier elements";
  EXPECT_EQ(gaps[1].sentence, "PARSE robot 'arm': broken");
}

TEST(MissingSources, AreErasedOneByOneOrByKind) {
  MissingSources missing(cell());
  for (const SourceId& source : {SourceId::ofMap("yard"), SourceId::ofRobot("arm")}) missing.set(source, "NOT_READY");
  missing.erase(SourceId::ofRobot("arm"));
  missing.erase(SourceId::ofRobot("nobody"));
  EXPECT_EQ(namesOf(missing), (std::vector<std::string>{"cloud/eye", "map/hall", "map/yard", "track/people"}));
  missing.eraseIf([](const SourceId& source) { return source.kind == SourceKind::map; });
  EXPECT_EQ(namesOf(missing), (std::vector<std::string>{"cloud/eye", "track/people"}));
}

}  // namespace
}  // namespace hgrid
