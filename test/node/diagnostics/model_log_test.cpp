// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/diagnostics/model_log.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace {

using ModelLogLines = std::vector<std::string>;

std::shared_ptr<const ModelReport> reportWith(const ModelLogLines& warnings) {
  auto report = std::make_shared<ModelReport>();
  report->warnings = warnings;
  return report;
}

TEST(ModelLog, HasEachWarningOnceAndSaysHowManyAreLeftOut) {
  ModelLog log;
  EXPECT_EQ(log.next(reportWith({})), ModelLogLines());
  const auto few = reportWith({"arm: odd", "~margins: 'x' matches no body"});
  EXPECT_EQ(log.next(few), few->warnings);
  EXPECT_EQ(log.next(few), ModelLogLines());
  EXPECT_EQ(log.next(reportWith({"arm: odd", "new", "~margins: 'x' matches no body"})), ModelLogLines({"new"}));
  ModelLogLines many;
  for (int i = 0; i < 1039; ++i) many.push_back("arm: unknown link " + std::to_string(i));
  const ModelLogLines lines = log.next(reportWith(many));
  ASSERT_EQ(lines.size(), ModelLog::kMostLines + 1);
  EXPECT_EQ(lines.front(), many.front());
  EXPECT_EQ(lines.back(), "... and 1034 more warnings; see model_warnings of ~status");
}

}  // namespace
}  // namespace hgrid
