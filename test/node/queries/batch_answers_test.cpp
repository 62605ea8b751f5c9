// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// How the answers to single questions become the response of ~query_batch.
#include "node/queries/batch_answers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

/// A snapshot with one obstacle, and a response.
struct Answered {
  explicit Answered(const std::string& outdated = "")
      : snapshot(snapshotOfOne()),
        prepared{*snapshot, "", Pose::Identity(), {}, {}},
        answers(prepared, outdated, 0.0, response) {}

  static std::shared_ptr<const Snapshot> snapshotOfOne() {
    Scene scene{SceneOptions{}};
    put(scene, ball("one"), at(0));
    return scene.commit(Time{1}, {});
  }
  static QueryAnswer clear() {
    QueryAnswer answer;
    answer.verdict = Verdict::clear;
    return answer;
  }
  static QueryAnswer hit(double cell_edge = QueryHit::kUnknown) {
    QueryAnswer answer;
    answer.verdict = Verdict::hit;
    answer.total = 1;
    answer.hits.emplace_back();
    answer.hits.back().cell_edge = cell_edge;
    return answer;
  }

  std::shared_ptr<const Snapshot> snapshot;
  PreparedQuery prepared;
  ::hgrid_proximity::QueryBatch::Response response;
  BatchAnswers answers;
};

constexpr auto kUnknownVerdict = static_cast<std::uint8_t>(Verdict::unknown);

TEST(BatchAnswers, OfAnOldTickAreNotClear) {
  Answered old("the newest tick is 3 s old");
  old.answers.add(Answered::clear());
  old.answers.add(Answered::hit());
  old.answers.finish();
  EXPECT_EQ(old.response.verdicts,
            (std::vector<std::uint8_t>{kUnknownVerdict, static_cast<std::uint8_t>(Verdict::hit)}));
  EXPECT_EQ(old.response.unknown_because[0], static_cast<std::uint8_t>(Unknown::outdated));
  EXPECT_EQ(old.response.texts, (std::vector<std::string>{"the newest tick is 3 s old", ""}));
}

// Claim: if the time was over before a question had examined everything, nobody is told that the hit is the nearest.
TEST(BatchAnswers, ToQuestionsThatRanOutOfTimeAreUnknown) {
  Answered late;
  QueryAnswer cut = Answered::hit();
  cut.examined_all = false;
  late.answers.add(cut);
  late.answers.add(Answered::hit());
  late.answers.finish();
  EXPECT_EQ(late.response.verdicts[0], kUnknownVerdict);
  EXPECT_EQ(late.response.unknown_because[0], static_cast<std::uint8_t>(Unknown::budget));
  EXPECT_NE(late.response.texts[0].find("max_time"), std::string::npos);
  EXPECT_EQ(late.response.totals, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(late.response.hits_end, (std::vector<std::uint32_t>{0, 1}));
}

TEST(BatchAnswers, HaveEdgesOfCellsForAllHitsIfOneHasThem) {
  Answered some;
  some.answers.add(Answered::hit());
  some.answers.add(Answered::hit(0.1));
  some.answers.add(Answered::hit());
  some.answers.finish();
  ASSERT_EQ(some.response.cell_edge.size(), 3u);
  EXPECT_TRUE(std::isnan(some.response.cell_edge[0]));
  EXPECT_EQ(some.response.cell_edge[1], 0.1);
  EXPECT_TRUE(std::isnan(some.response.cell_edge[2]));
  EXPECT_EQ(some.response.names, std::vector<std::string>{"obstacle/one"});
  EXPECT_EQ(some.response.body, (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(BatchAnswers, SayWhyAQuestionWasRefused) {
  Answered refused;
  refused.answers.refuse(Code::nonfinite, "sphere 0: no");
  refused.answers.finish();
  EXPECT_EQ(refused.response.codes, std::vector<std::uint16_t>{static_cast<std::uint16_t>(Code::nonfinite)});
  EXPECT_EQ(refused.response.unknown_because[0], static_cast<std::uint8_t>(Unknown::refused));
  EXPECT_EQ(refused.response.texts[0], "sphere 0: no");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
