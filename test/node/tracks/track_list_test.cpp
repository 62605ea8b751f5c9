// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests which tracks there are after a sequence of messages, with clocks that the test sets.
#include "src/node/tracks/track_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "hgrid_proximity/refusal.h"
#include "test/node/tracks/tracker_messages.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

using Places = std::map<std::string, double>;
using Reported = std::vector<std::pair<std::string, double>>;

Moment momentOf(double time) { return moment(1000.0 + time, 50.0 + time); }

Places placesIn(const TrackSet& set) {
  Places places;
  for (const Track& track : set.tracks) places[track.id] = track.world_from_track.translation().x();
  return places;
}

class TrackLists : public ::testing::Test {
 protected:
  void takeMarkers(double time, const Reported& xs) { take(markers_, reportAt(time, xs, true), time); }
  void takePoses(double time, const std::vector<double>& xs) {
    Reported reported;
    for (const double x : xs) reported.emplace_back("", x);
    take(poses_, reportAt(time, reported, false), time);
  }
  static std::size_t take(TrackList& list, const TrackReport& report, double time) {
    return list.take(report, placed(report), momentOf(time));
  }
  Places markers() const { return placesIn(markers_.set()); }
  Places poses() const { return placesIn(poses_.set()); }

  static TrackerParams withManyTracks(TrackerType type) {
    TrackerParams tracker = people(type);
    tracker.max_tracks = 1000;
    return tracker;
  }

  const Params params_;
  TrackList markers_{withManyTracks(TrackerType::markers), 2.0, params_, false};
  TrackList poses_{withManyTracks(TrackerType::poses), 2.0, params_, false};
};

TEST_F(TrackLists, KeepWhatIsNotReportedUntilItWasLostForTheConfiguredTime) {
  takeMarkers(0.0, {{"1", 1.0}, {"2", 2.0}});
  takeMarkers(1.0, {{"2", 2.5}});
  EXPECT_EQ(markers(), (Places{{"1", 1.0}, {"2", 2.5}}));
  EXPECT_FALSE(markers_.forget(momentOf(6.99))) << "LOST begins at ~lost_after, 2 s, and lasts 5 s";
  EXPECT_TRUE(markers_.forget(momentOf(7.01)));
  EXPECT_EQ(markers(), (Places{{"2", 2.5}}));
  EXPECT_TRUE(markers_.forget(momentOf(8.01)));
  EXPECT_EQ(markers(), Places());
}

TEST_F(TrackLists, TakeAMarkerAgainUnderItsId) {
  takeMarkers(0.0, {{"1", 1.0}});
  takeMarkers(6.0, {{"1", 50.0}});
  EXPECT_EQ(markers(), (Places{{"1", 50.0}})) << "an id decides, however far the marker has moved";
}

TEST_F(TrackLists, MeasureTheLimitOfASlowTrackerByItsPeriod) {
  for (int i = 0; i < 5; ++i) takeMarkers(4.0 * i, {{"1", 1.0}});
  EXPECT_NEAR(markers_.set().tracks[0].period, 4.0, 1e-9);
  EXPECT_FALSE(markers_.forget(momentOf(16.0 + 10.9))) << "LOST begins at 1.5 periods, 6 s";
  EXPECT_TRUE(markers_.forget(momentOf(16.0 + 11.1)));
}

TEST_F(TrackLists, LearnThePeriodOfEachTrackIfMessagesHaveOneTrackEach) {
  for (int i = 0; i < 40; ++i) takeMarkers(0.1 * i, {{std::to_string(i % 4), 1.0}});
  EXPECT_NEAR(markers_.set().period, 0.1, 1e-6);
  for (const Track& track : markers_.set().tracks) EXPECT_NEAR(track.period, 0.4, 1e-6) << track.id;
}

TEST_F(TrackLists, DoNotTakeAPoseThatIsOlderThanTheNewestOne) {
  takeMarkers(1.0, {{"1", 1.0}});
  EXPECT_EQ(take(markers_, reportAt(0.7, {{"1", 9.0}, {"2", 2.0}}, true), 1.1), 1u);
  EXPECT_EQ(markers(), (Places{{"1", 1.0}, {"2", 2.0}}));
  EXPECT_EQ(markers_.set().newest.stamp, s(1001.0));
  TrackReport again = reportAt(1.0, {{"1", 1.5}}, true);
  EXPECT_EQ(take(markers_, again, 1.2), 0u) << "the same stamp is not older";
}

TEST_F(TrackLists, TakeOlderStampsAfterTheClockWasSetBack) {
  takeMarkers(0.0, {{"1", 1.0}});
  TrackReport report = reportAt(0.0, {{"1", 2.0}}, true);
  report.arrival = moment(900.0, 50.1);
  report.stamp = report.poses[0].stamp = s(899.9);
  markers_.take(report, placed(report), report.arrival);
  EXPECT_EQ(markers(), (Places{{"1", 2.0}}));
  EXPECT_NEAR(markers_.set().newest.age(moment(900.0, 50.1), false), 0.1, 1e-9);
}

TEST_F(TrackLists, AgeByTheSteadyClock) {
  takeMarkers(0.0, {{"1", 1.0}});
  EXPECT_FALSE(markers_.forget(moment(5000.0, 51.0))) << "setting the wall clock ends no track";
  EXPECT_TRUE(markers_.forget(moment(1000.0, 58.0)));
}

TEST_F(TrackLists, AgeByASimulatedClock) {
  TrackList list(people(), 2.0, params_, true);
  take(list, reportAt(0.0, {{"1", 1.0}}, true), 0.0);
  EXPECT_FALSE(list.forget(moment(1001.0, 500.0)));
  EXPECT_TRUE(list.forget(moment(1008.0, 500.0)));
}

TEST_F(TrackLists, AssignEachPoseToTheNearestTrackThatCanBeThere) {
  takePoses(0.0, {1.0, 3.0});
  EXPECT_EQ(poses(), (Places{{"1", 1.0}, {"2", 3.0}}));
  takePoses(0.1, {2.8, 1.2});
  EXPECT_EQ(poses(), (Places{{"1", 1.2}, {"2", 2.8}})) << "in any order";
  takePoses(0.2, {1.4});
  EXPECT_EQ(poses(), (Places{{"1", 1.4}, {"2", 2.8}})) << "what is not reported stays where it was";
}

TEST_F(TrackLists, MakeANewTrackOfAPoseThatIsTooFarAway) {
  takePoses(0.0, {1.0});
  takePoses(0.1, {1.29});  // 2 m/s for 0.1 s and 0.1 m of noise
  EXPECT_EQ(poses(), (Places{{"1", 1.29}}));
  takePoses(0.2, {1.6});
  EXPECT_EQ(poses(), (Places{{"1", 1.29}, {"2", 1.6}}));
  takePoses(1.0, {2.8, 1.3});
  EXPECT_EQ(poses(), (Places{{"1", 1.3}, {"2", 2.8}})) << "in 0.9 s the first one can have moved 1.9 m";
}

TEST_F(TrackLists, AssignTheNearestPairFirst) {
  takePoses(0.0, {0.0, 1.0});
  takePoses(1.0, {0.9, 1.5});
  EXPECT_EQ(poses(), (Places{{"1", 1.5}, {"2", 0.9}})) << "0.9 is nearer to 1.0 than 1.5 is";
}

TEST_F(TrackLists, DecideTiesByTheOrderOfTracksAndPoses) {
  takePoses(0.0, {1.0});
  takePoses(1.0, {0.5, 1.5});
  EXPECT_EQ(poses(), (Places{{"1", 0.5}, {"2", 1.5}}));
}

TEST_F(TrackLists, NeverUseAnIdAgain) {
  takePoses(0.0, {1.0});
  EXPECT_TRUE(poses_.forget(momentOf(100.0)));
  takePoses(100.0, {1.0});
  EXPECT_EQ(poses(), (Places{{"2", 1.0}}));
}

TEST_F(TrackLists, RefuseWhatExceedsTheLimitAndStayAsTheyWere) {
  TrackerParams tracker = people(TrackerType::poses);
  tracker.max_tracks = 2;
  TrackList list(tracker, 2.0, params_, false);
  take(list, reportAt(0.0, {{"", 1.0}, {"", 2.0}}, false), 0.0);
  try {
    take(list, reportAt(0.1, {{"", 1.1}, {"", 50.0}}, false), 0.1);
    FAIL() << "a third track was accepted";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), Code::limit);
    EXPECT_NE(std::string(refusal.what()).find("would be 3 tracks"), std::string::npos) << refusal.what();
  }
  EXPECT_EQ(placesIn(list.set()), (Places{{"1", 1.0}, {"2", 2.0}}));
  take(list, reportAt(7.2, {{"", 50.0}}, false), 7.2);
  EXPECT_EQ(placesIn(list.set()), (Places{{"3", 50.0}})) << "a refused message uses up no id";
}

TEST_F(TrackLists, SayWhyAMessageWasRefusedUntilTheNextGoodOne) {
  EXPECT_FALSE(poses_.set().heard);
  poses_.noteRefused("why");
  EXPECT_EQ(poses_.set().refused, "why");
  EXPECT_FALSE(poses_.set().heard);
  takePoses(0.0, {});
  EXPECT_EQ(poses_.set().refused, "");
  EXPECT_TRUE(poses_.set().heard);
}

/// Claim: after random messages the list contains what a simple model contains.
TEST_F(TrackLists, OfMarkersAreWhatASimpleModelSays) {
  Random random(1);
  std::map<std::string, std::pair<double, double>> model;  // place and time of the newest report, by id
  double time = 0.0;
  for (int round = 0; round < 3000; ++round) {
    time += random.chance(0.1) ? random.uniform(0.0, 4.0) : 0.1;
    Reported reported;
    for (int id = 0; id < 4; ++id) {
      if (random.chance(0.2)) reported.emplace_back(std::to_string(id), random.uniform(0.0, 10.0));
    }
    takeMarkers(time, reported);
    for (const auto& [id, x] : reported) model[id] = {x, time};
    // The period is at most 4 s, and LOST begins at 1.5 periods at the latest; so tracks end after 7 to 11 s.
    const Places places = markers();
    for (auto track = model.begin(); track != model.end();) {
      const double age = time - track->second.second;
      const auto found = places.find(track->first);
      if (found != places.end()) {
        ASSERT_EQ(found->second, track->second.first) << "round " << round;
        ASSERT_LE(age, 11.1) << "round " << round;
      } else {
        ASSERT_GE(age, 6.9) << "round " << round;
      }
      track = found == places.end() ? model.erase(track) : std::next(track);
    }
    for (const auto& place : places) ASSERT_EQ(model.count(place.first), 1u) << "round " << round;
  }
}

/// Assigns poses in the simplest way: looks for the nearest pair again and again.
std::vector<std::string> assignedByModel(const TrackSet& set, const std::vector<double>& xs, double time,
                                         int& last_id) {
  std::vector<std::string> ids(xs.size());
  std::vector<bool> used(set.tracks.size());
  for (;;) {
    std::optional<std::pair<std::size_t, std::size_t>> best;
    double least = 0.0;
    for (std::size_t track = 0; track < set.tracks.size(); ++track) {
      for (std::size_t pose = 0; pose < xs.size(); ++pose) {
        const double distance = std::abs(set.tracks[track].world_from_track.translation().x() - xs[pose]);
        const double elapsed = 1000.0 + time - seconds(set.tracks[track].time.stamp);
        if (used[track] || !ids[pose].empty() || distance > 2.0 * elapsed + 0.1) continue;
        if (best && distance >= least) continue;
        best = std::pair(track, pose);
        least = distance;
      }
    }
    if (!best) break;
    used[best->first] = true;
    ids[best->second] = set.tracks[best->first].id;
  }
  for (std::string& id : ids) {
    if (id.empty()) id = std::to_string(++last_id);
  }
  return ids;
}

/// Claim: poses are assigned as by a search for the nearest pair, again and again.
TEST_F(TrackLists, OfPosesAreWhatASimpleModelSays) {
  Random random(2);
  double time = 0.0;
  int last_id = 0, assigned = 0;
  for (int round = 0; round < 1500; ++round) {
    time += random.chance(0.1) ? random.uniform(0.0, 4.0) : 0.1;
    poses_.forget(momentOf(time));
    std::vector<double> xs;
    for (int count = random.below(6); count > 0; --count) xs.push_back(0.1234567 * random.below(640));
    const TrackSet before = poses_.set();
    const std::vector<std::string> ids = assignedByModel(before, xs, time, last_id);
    Places expected = placesIn(before);
    for (std::size_t i = 0; i < xs.size(); ++i) {
      assigned += expected.count(ids[i]) != 0 ? 1 : 0;
      expected[ids[i]] = xs[i];
    }
    takePoses(time, xs);
    ASSERT_EQ(poses(), expected) << "round " << round;
  }
  EXPECT_GT(assigned, 1000);
  EXPECT_GT(last_id, 100);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
