// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <stdexcept>

#include "src/node/params/params.h"
#include "test/node/support/values.h"

namespace hgrid {
namespace test {
namespace {

Value person() {
  return dict({{"name", "people"},
               {"topic", "people"},
               {"type", "markers"},
               {"shapes", list({dict({{"type", "capsule"}, {"height", 1.0}, {"radius", 0.3}, {"padding", 0.05}})})}});
}

/// Returns the error message; empty if the trackers are accepted.
std::string errorsOf(const Value& trackers) {
  try {
    readParams(dict({{"tracks", trackers}}));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expectRefused(const Value& tracker, const std::string& sentence) {
  const std::string errors = errorsOf(list({tracker}));
  EXPECT_NE(errors.find(sentence), std::string::npos) << "found: " << errors;
}

TEST(TrackerParams, AreReadWithTheirDefaults) {
  const Params params = readParams(dict({{"tracks", list({person()})}}));
  ASSERT_EQ(params.trackers.size(), 1u);
  const TrackerParams& tracker = params.trackers[0];
  EXPECT_EQ(tracker.name, "people");
  EXPECT_EQ(tracker.topic, "people");
  EXPECT_EQ(tracker.type, TrackerType::markers);
  ASSERT_EQ(tracker.shapes.size(), 1u);
  EXPECT_EQ(tracker.shapes[0].padding, 0.05);
  EXPECT_EQ(tracker.forget, 5.0);
  EXPECT_EQ(tracker.max_tracks, 100);
  EXPECT_FALSE(tracker.upright);
}

TEST(TrackerParams, AreReadAsGiven) {
  const Value carts = with(person(), {{"type", "poses"},
                                      {"upright", true},
                                      {"max_speed", 1.5},
                                      {"margin", 0.4},
                                      {"noise", 0.0},
                                      {"forget", 60},
                                      {"max_tracks", 1000}});
  const TrackerParams tracker = readParams(dict({{"tracks", list({carts})}})).trackers[0];
  EXPECT_EQ(tracker.type, TrackerType::poses);
  EXPECT_TRUE(tracker.upright);
  EXPECT_EQ(tracker.max_speed, 1.5);
  EXPECT_EQ(tracker.margin, 0.4);
  EXPECT_EQ(tracker.noise, 0.0);
  EXPECT_EQ(tracker.forget, 60.0);
  EXPECT_EQ(tracker.max_tracks, 1000);
}

TEST(TrackerParams, ThatAreWrongAreRefusedByName) {
  expectRefused(with(person(), {{"name", "a/b"}}), "~tracks[0] has the name 'a/b'; the name of a tracker must not");
  expectRefused(with(person(), {{"type", "tracks"}}), "~tracks[0]/type is 'tracks'; it must be markers or poses");
  expectRefused(with(person(), {{"topic", "two words"}}), "~tracks[0] has the topic 'two words'");
  expectRefused(with(person(), {{"shapes", list()}}), "~tracks[0]/shapes has no shape; it must have at least one");
  expectRefused(with(person(), {{"forget", 0.0}}), "~tracks[0]/forget is 0 s; it must be within 0.1 .. 86400 s");
  expectRefused(with(person(), {{"max_tracks", 0}}), "~tracks[0]/max_tracks is 0; it must be within 1 .. 1000");
  expectRefused(with(person(), {{"speed", 1.0}}), "~tracks[0]/speed is not a field of a tracker");
  expectRefused(with(person(), {{"type", "poses"}, {"namespaces", list({"legs"})}}), "only markers have namespaces");
  EXPECT_NE(errorsOf(list({person(), person()})).find("'people', which is already used"), std::string::npos);
  for (const char* required : {"name", "topic", "type", "shapes"}) {
    Value tracker;
    for (const auto& member : person()) {
      if (member.first != required) tracker[member.first] = member.second;
    }
    expectRefused(tracker, std::string("~tracks[0] has no '") + required + "'");
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
