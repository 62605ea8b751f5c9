// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <hgrid_proximity/AllowedPair.h>
#include <hgrid_proximity/Answer.h>
#include <hgrid_proximity/Body.h>
#include <hgrid_proximity/Code.h>
#include <hgrid_proximity/Events.h>
#include <hgrid_proximity/Shape.h>
#include <hgrid_proximity/WorldState.h>

#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"

// The numbers on the wire are those of the library.

namespace hgrid {
namespace test {
namespace {

namespace msg = ::hgrid_proximity;

template <class Enum>
int number(Enum value) {
  return static_cast<int>(value);
}

TEST(Constants, CodesAreThoseOfTheLibraryByNumberAndByName) {
  struct Row {
    int wire;
    Code code;
    const char* name;
  };
#define ROW(UPPER, lower) \
  { msg::Code::UPPER, Code::lower, #UPPER }
  const Row rows[] = {ROW(OK, ok),
                      ROW(BAD_ID, bad_id),
                      ROW(DUP_ID, dup_id),
                      ROW(UNKNOWN_ID, unknown_id),
                      ROW(NONFINITE, nonfinite),
                      ROW(OUT_OF_RANGE, out_of_range),
                      ROW(BAD_GEOMETRY, bad_geometry),
                      ROW(BAD_ROTATION, bad_rotation),
                      ROW(LIMIT, limit),
                      ROW(UNKNOWN_FRAME, unknown_frame),
                      ROW(TF_TIMEOUT, tf_timeout),
                      ROW(EXTRAPOLATION, extrapolation),
                      ROW(CLOCK, clock),
                      ROW(PARSE, parse),
                      ROW(TRUNCATED, truncated),
                      ROW(UNSUPPORTED, unsupported),
                      ROW(RESOURCE_DENIED, resource_denied),
                      ROW(RESOURCE_MISSING, resource_missing),
                      ROW(BUDGET, budget),
                      ROW(BUSY, busy),
                      ROW(NOT_READY, not_ready),
                      ROW(VERSION, version),
                      ROW(CHECKSUM, checksum),
                      ROW(INTERNAL, internal),
                      ROW(CONFLICT, conflict),
                      ROW(NEEDS_FORCE, needs_force),
                      ROW(FAILED, failed)};
#undef ROW
  int next = 0;
  for (const Row& row : rows) {
    EXPECT_EQ(row.wire, next++) << row.name << ": the numbers never change";
    EXPECT_EQ(row.wire, number(row.code)) << row.name;
    EXPECT_STREQ(row.name, name(row.code));
  }
}

TEST(Constants, StatesAreThoseOfTheLibraryByNumberAndByName) {
  EXPECT_EQ(msg::WorldState::FRESH, number(Freshness::fresh));
  EXPECT_EQ(msg::WorldState::LATE, number(Freshness::late));
  EXPECT_EQ(msg::WorldState::STALE, number(Freshness::stale));
  EXPECT_EQ(msg::WorldState::LOST, number(Freshness::lost));
  EXPECT_EQ(msg::WorldState::FROZEN, number(Freshness::frozen));
  EXPECT_EQ(msg::WorldState::INVALID, number(Freshness::invalid));
  EXPECT_EQ(msg::WorldState::UNPLACED, number(Freshness::unplaced));
  const char* const names[] = {"FRESH", "LATE", "STALE", "LOST", "FROZEN", "INVALID", "UNPLACED"};
  for (int i = 0; i < 7; ++i) EXPECT_STREQ(name(static_cast<Freshness>(i)), names[i]);
}

TEST(Constants, ShapesAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::Shape::SPHERE, number(ShapeKind::sphere));
  EXPECT_EQ(msg::Shape::BOX, number(ShapeKind::box));
  EXPECT_EQ(msg::Shape::CYLINDER, number(ShapeKind::cylinder));
  EXPECT_EQ(msg::Shape::CONE, number(ShapeKind::cone));
  EXPECT_EQ(msg::Shape::CAPSULE, number(ShapeKind::capsule));
  EXPECT_EQ(msg::Shape::HULL, number(ShapeKind::hull));
  EXPECT_EQ(msg::Shape::MESH, number(ShapeKind::mesh));
}

TEST(Constants, VerdictsAndMobilitiesAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::Answer::UNKNOWN, number(Verdict::unknown));
  EXPECT_EQ(msg::Answer::CLEAR, number(Verdict::clear));
  EXPECT_EQ(msg::Answer::HIT, number(Verdict::hit));
  EXPECT_EQ(msg::Body::FIXED, number(Mobility::fixed));
  EXPECT_EQ(msg::Body::MOVING, number(Mobility::moving));
}

TEST(Constants, KindsAndCausesOfEventsAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::Events::BEGIN, number(EventKind::begin));
  EXPECT_EQ(msg::Events::END, number(EventKind::end));
  EXPECT_EQ(msg::Events::MOVED, number(EventCause::moved));
  EXPECT_EQ(msg::Events::BODIES, number(EventCause::bodies));
  EXPECT_EQ(msg::Events::FILTER, number(EventCause::filter));
  EXPECT_EQ(msg::Events::STALENESS, number(EventCause::staleness));
  EXPECT_EQ(msg::Events::EPOCH, number(EventCause::epoch));
}

TEST(Constants, OriginsOfAllowedPairsAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::AllowedPair::ORIGIN_NONE, number(Origin::none));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_RIGID, number(Origin::rigid));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_ADJACENT, number(Origin::adjacent));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_SRDF, number(Origin::srdf));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_PARAMETER, number(Origin::parameter));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_SERVICE, number(Origin::service));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_KIND, number(Origin::kind));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_ATTACHED, number(Origin::attached));
  EXPECT_EQ(msg::AllowedPair::ORIGIN_SELF, number(Origin::self));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
