// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <hgrid_proximity/AllowedPair.h>
#include <hgrid_proximity/Answer.h>
#include <hgrid_proximity/Body.h>
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/CodeNames.h>
#include <hgrid_proximity/EventCause.h>
#include <hgrid_proximity/EventKind.h>
#include <hgrid_proximity/Events.h>
#include <hgrid_proximity/Mobility.h>
#include <hgrid_proximity/RuleOrigin.h>
#include <hgrid_proximity/Shape.h>
#include <hgrid_proximity/ShapeKind.h>
#include <hgrid_proximity/Verdict.h>
#include <hgrid_proximity/WorldState.h>

#include "hgrid_proximity/queries/query_answer.h"
#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/world/snapshot.h"

// The constants in the messages have the same numbers as the enums of the library.

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
  { msg::CodeNames::UPPER, Code::lower, #UPPER }
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
  EXPECT_EQ(msg::BodyState::FRESH, number(Freshness::fresh));
  EXPECT_EQ(msg::BodyState::LATE, number(Freshness::late));
  EXPECT_EQ(msg::BodyState::STALE, number(Freshness::stale));
  EXPECT_EQ(msg::BodyState::LOST, number(Freshness::lost));
  EXPECT_EQ(msg::BodyState::FROZEN, number(Freshness::frozen));
  EXPECT_EQ(msg::BodyState::INVALID, number(Freshness::invalid));
  EXPECT_EQ(msg::BodyState::UNPLACED, number(Freshness::unplaced));
  const char* const names[] = {"FRESH", "LATE", "STALE", "LOST", "FROZEN", "INVALID", "UNPLACED"};
  for (int i = 0; i < 7; ++i) EXPECT_STREQ(name(static_cast<Freshness>(i)), names[i]);
}

TEST(Constants, ShapesAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::ShapeKind::SPHERE, number(ShapeKind::sphere));
  EXPECT_EQ(msg::ShapeKind::BOX, number(ShapeKind::box));
  EXPECT_EQ(msg::ShapeKind::CYLINDER, number(ShapeKind::cylinder));
  EXPECT_EQ(msg::ShapeKind::CONE, number(ShapeKind::cone));
  EXPECT_EQ(msg::ShapeKind::CAPSULE, number(ShapeKind::capsule));
  EXPECT_EQ(msg::ShapeKind::HULL, number(ShapeKind::hull));
  EXPECT_EQ(msg::ShapeKind::MESH, number(ShapeKind::mesh));
  EXPECT_EQ(msg::ShapeKind::PLANE, number(ShapeKind::plane));
}

TEST(Constants, VerdictsAndMobilitiesAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::Verdict::UNKNOWN, number(Verdict::unknown));
  EXPECT_EQ(msg::Verdict::CLEAR, number(Verdict::clear));
  EXPECT_EQ(msg::Verdict::HIT, number(Verdict::hit));
  EXPECT_EQ(msg::Mobility::FIXED, number(Mobility::fixed));
  EXPECT_EQ(msg::Mobility::MOVING, number(Mobility::moving));
}

TEST(Constants, KindsAndCausesOfEventsAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::EventKind::BEGIN, number(EventKind::begin));
  EXPECT_EQ(msg::EventKind::END, number(EventKind::end));
  EXPECT_EQ(msg::EventCause::MOVED, number(EventCause::moved));
  EXPECT_EQ(msg::EventCause::BODIES, number(EventCause::bodies));
  EXPECT_EQ(msg::EventCause::FILTER, number(EventCause::filter));
  EXPECT_EQ(msg::EventCause::STALENESS, number(EventCause::staleness));
  EXPECT_EQ(msg::EventCause::EPOCH, number(EventCause::epoch));
}

TEST(Constants, OriginsOfAllowedPairsAreThoseOfTheLibrary) {
  EXPECT_EQ(msg::RuleOrigin::NONE, number(Origin::none));
  EXPECT_EQ(msg::RuleOrigin::RIGID, number(Origin::rigid));
  EXPECT_EQ(msg::RuleOrigin::ADJACENT, number(Origin::adjacent));
  EXPECT_EQ(msg::RuleOrigin::SRDF, number(Origin::srdf));
  EXPECT_EQ(msg::RuleOrigin::PARAMETER, number(Origin::parameter));
  EXPECT_EQ(msg::RuleOrigin::SERVICE, number(Origin::service));
  EXPECT_EQ(msg::RuleOrigin::KIND, number(Origin::kind));
  EXPECT_EQ(msg::RuleOrigin::ATTACHED, number(Origin::attached));
  EXPECT_EQ(msg::RuleOrigin::SELF, number(Origin::self));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
