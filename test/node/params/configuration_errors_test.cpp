// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <limits>

#include "src/node/params/params.h"
#include "test/node/support/claims.h"
#include "test/node/support/values.h"

// Tests the error messages about wrong parameters. Needs no node, which would only print the message and end.

namespace hgrid {
namespace test {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

/// Returns the error message for these parameters; empty if they are accepted.
std::string refusalOf(const Value& params) {
  try {
    readParams(params);
    return {};
  } catch (const std::invalid_argument& refusal) {
    return refusal.what();
  }
}

void expectRefused(const Value& params, const std::string& sentence) {
  const std::string message = refusalOf(params);
  EXPECT_EQ(message, "1 parameter is wrong:\n  " + sentence);
}

std::string refusalOfShape(const Value& shape, const Value& more = dict()) {
  Value params = more;
  params["obstacles"] = list({dict({{"name", "o"}, {"shapes", list({shape})}})});
  return refusalOf(params);
}

TEST(ParamErrors, AWrongTypeIsNamed) {
  expectRefused(dict({{"rate", "fast"}}), "~rate is a string ('fast'); it must be a number");
  expectRefused(dict({{"rate", true}}), "~rate is a boolean; it must be a number");
  expectRefused(dict({{"limits/max_pairs", 2.5}}), "~limits/max_pairs is a number; it must be an integer");
  expectRefused(dict({{"limits/allow_flat", 1}}), "~limits/allow_flat is an integer; it must be true or false");
  expectRefused(dict({{"world_frame", 3}}), "~world_frame is an integer; it must be a string");
  expectRefused(dict({{"origin", 3.0}}), "~origin is a number; it must be a list");
  expectRefused(dict({{"origin", list({Value(1.0)})}}), "~origin has 1 elements; it must have 3");
  expectRefused(dict({{"origin", list({Value(1.0), Value("x"), Value(2)})}}),
                "~origin[1] is a string ('x'); it must be a number");
  expectRefused(dict({{"mesh_roots", "x"}}), "~mesh_roots is a string ('x'); it must be a list");
  expectRefused(dict({{"use_visual", "robot/*"}}), "~use_visual is a string ('robot/*'); it must be a list");
  expectRefused(dict({{"robots", list({Value("ur5")})}}), "~robots[0] is a string ('ur5'); it must be a dictionary");
}

TEST(ParamErrors, AWrongMapOptionIsNamed) {
  expectRefused(dict({{"map", dict({{"unknown", "guess"}})}}),
                "~map/unknown is 'guess'; it must be ignore, report or occupied");
  expectRefused(dict({{"map", dict({{"crop_min", list({0.0, 2.0, 0.0})}, {"crop_max", list({1.0, 1.0, 1.0})}})}}),
                "~map/crop_min is 2 m along y and ~map/crop_max is 1 m; crop_min must be at most crop_max");
}

TEST(ParamErrors, AnUnknownTypeOfBroadPhaseIsNamed) {
  expectRefused(dict({{"broadphase", dict({{"type", "octree"}})}}),
                "~broadphase/type is 'octree'; it must be one of hgrid, hashed_hgrid, hashed_grid, bucket_grid, "
                "array_grid, bit_grid, "
                "mirtich_grid, loose_octree, kd_tree, tree_grid, sweep_lists, sweep_array");
  EXPECT_EQ(refusalOf(dict({{"broadphase", dict({{"type", "kd_tree"}})}})), "");
}

TEST(ParamErrors, InvalidTopicsAndPatternsAreNamed) {
  const auto cloud = [](const char* topic) {
    return dict({{"clouds", list({dict({{"name", "a"}, {"topic", topic}})})}});
  };
  EXPECT_NE(refusalOf(cloud("my topic!")).find("~clouds[0] has the topic 'my topic!': Character"), std::string::npos);
  expectRefused(cloud(""), "~clouds[0] has the topic '': it must not be empty");
  EXPECT_NE(
      refusalOf(dict({{"maps", list({dict({{"name", "a"}, {"topic", "b//\x01"}})})}})).find("~maps[0] has the topic"),
      std::string::npos);
  expectRefused(dict({{"padding", list({dict({{"pattern", "cloud/*"}, {"padding", 0.1}})})}}),
                "~padding has the pattern 'cloud/*'; cells of maps and clouds cannot be grown, use ~margins or "
                "~map/self_filter");
  expectRefused(dict({{"map", dict({{"unknown", true}})}}), "~map/unknown is a boolean; it must be a string");
}

TEST(ParamErrors, AFormerNameSaysWhatToWriteNow) {
  expectRefused(dict({{"max_pairs", 5}}), "~max_pairs is now ~limits/max_pairs");
  expectRefused(dict({{"map/max_leaves", 5}}), "~map/max_leaves is now ~limits/max_map_leaves");
  expectRefused(dict({{"clock_jump", 1.0}}),
                "~clock_jump is gone: ROS time has jumped if it gains more than 10 s on real time within one tick");
}

TEST(ParamErrors, ANumberOutOfRangeIsNamedWithTheRange) {
  expectRefused(dict({{"rate", 0.0}}), "~rate is 0 Hz; it must be within 1 .. 1000 Hz");
  expectRefused(dict({{"rate", kNan}}), "~rate is nan Hz; it must be within 1 .. 1000 Hz");
  expectRefused(dict({{"margin", -0.01}}), "~margin is -0.01 m; it must be within 0 .. 1000 m");
  expectRefused(dict({{"margin", kInfinity}}), "~margin is inf m; it must be within 0 .. 1000 m");
  expectRefused(dict({{"query_threads", 0}}), "~query_threads is 0; it must be within 1 .. 64");
  expectRefused(
      dict({{"stale_after", 5.0}}),
      "~late_after is 0.1 s, ~stale_after is 5 s and ~lost_after is 2 s; none may be smaller than the one before it");
  expectRefused(dict({{"margins", list({dict({{"pattern", "*"}, {"margin", -1}})})}}),
                "~margins[0]/margin is -1 m; it must be within 0 .. 1000 m");
  EXPECT_EQ(refusalOf(dict({{"rate", 1}, {"valid_for", 1}, {"margin", 1000}, {"query_threads", 64}})), "")
      << "both ends are allowed";
  expectRefused(dict({{"rate", 5}}), "~valid_for is 0.1 s; it must be at least one period of ~rate, 0.2 s");
  expectRefused(dict({{"heartbeat", 5}}), "~valid_for is 0.1 s; it must be at least one period of ~heartbeat, 0.2 s");
  EXPECT_EQ(refusalOf(dict({{"heartbeat", 5}, {"follow_data", false}})), "");
}

TEST(ParamErrors, AnUnknownNameIsRefusedWhereverItStands) {
  expectRefused(dict({{"marign", 0.1}}), "~marign is not a parameter of this node; the name may be misspelled");
  expectRefused(dict({{"robots", list({dict({{"name", "a"}, {"description", "d"}, {"urdf", "x"}})})}}),
                "~robots[0]/urdf is not a field of a robot (name, description, semantic, tf_prefix, joint_states); the "
                "name may be misspelled");
  expectRefused(
      dict({{"pair_kinds", list({Value("self"), Value("all")})}}),
      "~pair_kinds contains 'all'; allowed kinds are self, robot_robot, robot_obstacle, robot_map, moving_obstacle");
  EXPECT_TRUE(says(refusalOf(dict({{"obstacles", list({with(ball("o", 0, 0, 0, 1), {{"colour", "red"}})})}})),
                   "~obstacles[0]/colour is not a field of an obstacle"));
}

TEST(ParamErrors, RobotsNeedNamesOfTheirOwnAndACommonFrame) {
  const auto robot = [](const char* name) { return dict({{"name", name}, {"description", "d"}}); };
  const auto errors = [&](const Value& first, const Value& second) {
    return refusalOf(dict({{"world_frame", "world"}, {"robots", list({first, second})}}));
  };
  EXPECT_EQ(errors(robot("a"), robot("b")), "");
  EXPECT_TRUE(says(errors(robot("a"), robot("a")), "~robots[1]/name is 'a', which is already used"));
  for (const char* reserved : {"obstacle", "map", "cloud", "track"}) {
    EXPECT_TRUE(says(errors(robot("a"), robot(reserved)), "obstacle, map, cloud and track are reserved")) << reserved;
  }
  EXPECT_TRUE(says(errors(robot("a"), robot("a/b")), "it must not contain a slash"));
  EXPECT_TRUE(says(errors(robot("a"), robot("")), "it must not be empty"));
  EXPECT_TRUE(says(errors(robot("a"), dict({{"name", "b"}})), "~robots[1] has no 'description'; it must have one"));
  EXPECT_TRUE(says(refusalOf(dict({{"robots", list({robot("a"), robot("b")})}})),
                   "~world_frame is empty; with several robots it must name a frame that tf connects to all of them"));
}

TEST(ParamErrors, ShapesThatCannotExistAreRefused) {
  for (const double bad : {0.0, -1.0, kNan, kInfinity, 1e-320, 1e308}) {
    SCOPED_TRACE(bad);
    const std::string sphere = refusalOfShape(dict({{"type", "sphere"}, {"radius", bad}}));
    EXPECT_TRUE(says(sphere, "~obstacles[0]/shapes[0] is not a valid shape: sphere: radius is "));
    EXPECT_TRUE(says(sphere, std::isfinite(bad) ? "m; it must be within 0.0001 .. 100000 m" : "it must be finite"));
    EXPECT_TRUE(says(refusalOfShape(dict({{"type", "box"}, {"size", xyz(1, bad, 1)}})), "box: side y is "));
    for (const char* type : {"cylinder", "cone", "capsule"}) {
      EXPECT_TRUE(says(refusalOfShape(dict({{"type", type}, {"height", bad}, {"radius", 1.0}})),
                       std::string(type) + ": height is "));
      EXPECT_TRUE(says(refusalOfShape(dict({{"type", type}, {"height", 1.0}, {"radius", bad}})),
                       std::string(type) + ": radius is "));
    }
  }
}

TEST(ParamErrors, APlateIsABoxOnlyWhereThatIsAllowed) {
  const Value plate = dict({{"type", "box"}, {"size", xyz(1, 1, 0)}});
  EXPECT_TRUE(says(refusalOfShape(plate), "box: side z is 0 m"));
  EXPECT_EQ(refusalOfShape(plate, dict({{"limits/allow_flat", true}})), "");
  EXPECT_TRUE(says(refusalOfShape(dict({{"type", "box"}, {"size", xyz(1, 0, 0)}}), dict({{"limits/allow_flat", true}})),
                   "box: side y is 0 m"))
      << "at most one side may be 0";
}

TEST(ParamErrors, ShapesNeedTheirOwnDimensions) {
  EXPECT_TRUE(says(refusalOfShape(dict({{"type", "box"}, {"size", list({Value(1.0), Value(1.0)})}})),
                   "/size has 2 elements; it must have 3"));
  EXPECT_TRUE(says(refusalOfShape(dict({{"type", "sphere"}})), "has no 'radius'; it must have one"));
  EXPECT_TRUE(says(refusalOfShape(dict({{"type", "sphere"}, {"radius", 1.0}, {"height", 1.0}})),
                   "/height is not a field of a shape"));
  EXPECT_TRUE(says(refusalOfShape(dict({{"type", "cylinder"}, {"radius", 1.0}})), "has no 'height'"));
  EXPECT_TRUE(says(refusalOfShape(dict({{"type", "teapot"}})),
                   "has type 'teapot'; it must be box, sphere, cylinder, cone, capsule, hull, mesh or plane"));
  EXPECT_TRUE(says(refusalOf(dict({{"obstacles", list({dict({{"name", "o"}, {"shapes", list()}})})}})),
                   "has no shape; it must have at least one"));
  EXPECT_TRUE(says(refusalOf(dict({{"obstacles", list({dict({{"name", "o"}})})}})), "has no 'shapes'"));
}

TEST(ParamErrors, ObstaclesNeedNames) {
  const auto refusal = [](const std::string& name) {
    return refusalOf(dict({{"obstacles", list({ball(name, 0, 0, 0, 1)})}}));
  };
  EXPECT_TRUE(says(refusal(""), "~obstacles[0]/name is not a valid name: it is ''; it must not be empty"));
  EXPECT_TRUE(says(refusal(std::string(10000, 'x')), "it has 10000 bytes; at most 128 are allowed"));
  EXPECT_TRUE(says(refusal(std::string("a\0b", 3)), "a\\x00b'; it must be UTF-8 without control characters"));
  EXPECT_TRUE(says(refusal("a\nb"), "a\\x0ab'; it must be UTF-8 without control characters"));
  EXPECT_TRUE(says(refusal("a\xff"), "a\\xff'; it must be UTF-8 without control characters"));
  EXPECT_EQ(refusal("../a"), "") << "a name is not a path";
  EXPECT_EQ(refusal(std::string(128, 'x')), "");
  EXPECT_EQ(refusal("Tür/links"), "");
  EXPECT_TRUE(says(refusalOf(dict({{"obstacles", list({ball("o", 0, 0, 0, 1), ball("o", 1, 0, 0, 1)})}})),
                   "~obstacles[1]/name is 'o', which is already used; names must differ"));
}

TEST(ParamErrors, PosesOfObstaclesMustBeFiniteAndWithinTheWorld) {
  for (const double bad : {kNan, kInfinity, 1e300}) {
    EXPECT_TRUE(
        says(refusalOf(dict({{"obstacles", list({ball("o", 0, bad, 0, 1)})}})), "~obstacles[0]/pose/xyz[1] is "));
  }
}

TEST(ParamErrors, AllOfThemAreListedInOneMessage) {
  const std::string message = refusalOf(dict({{"rate", "fast"}, {"marign", 0.1}, {"margin", -1}, {"origin", 3}}));
  EXPECT_EQ(message,
            "4 parameters are wrong:\n"
            "  ~origin is an integer; it must be a list\n"
            "  ~rate is a string ('fast'); it must be a number\n"
            "  ~margin is -1 m; it must be within 0 .. 1000 m\n"
            "  ~marign is not a parameter of this node; the name may be misspelled");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
