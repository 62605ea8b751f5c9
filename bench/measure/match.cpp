// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/measure/match.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace hgrid {
namespace bench {
namespace {

using Result = std::pair<std::uint64_t, std::uint64_t>;  // count and checksum

Result resultOf(const Sample& sample) { return {sample.count, sample.checksum}; }

/// Returns the result with the most votes. Returns null if that is only one vote, or if two results have the most
/// votes.
const Result* elected(const std::map<Result, int>& votes) {
  const Result* best = nullptr;
  int most = 1;
  for (const auto& [result, count] : votes) {
    if (count == most) best = nullptr;
    if (count > most) best = &result, most = count;
  }
  return best;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Score timesOf(const std::vector<std::vector<Sample>>& blocks) {
  Score score;
  std::vector<double> medians, all;
  for (const std::vector<Sample>& block : blocks) {
    std::vector<double> times;
    for (const Sample& sample : block) {
      if (sample.timed) times.push_back(sample.ms);
      score.bytes = std::max(score.bytes, sample.bytes);
    }
    if (times.empty()) continue;
    medians.push_back(median(times));
    all.insert(all.end(), times.begin(), times.end());
  }
  if (all.empty()) return score;
  score.timed = all.size();
  score.median_ms = median(medians);
  score.min_ms = *std::min_element(all.begin(), all.end());
  const auto [low, high] = std::minmax_element(medians.begin(), medians.end());
  score.spread = score.median_ms > 0.0 ? (*high - *low) / score.median_ms : 0.0;
  return score;
}

}  // namespace

void Match::add(std::unique_ptr<Contestant> contestant, bool votes, bool decides) {
  entries_.push_back({std::move(contestant), votes, decides});
}

void Match::play(int rounds, double budget_ms, double limit_s) {
  for (int round = 0; round < rounds; ++round) {
    for (Entry& entry : entries_) entry.contestant->play(budget_ms, limit_s);
  }
}

std::vector<Score> Match::scores() const {
  std::map<std::uint64_t, std::map<Result, int>> votes;
  std::map<std::uint64_t, Result> reference = decided_;  // sample number -> result
  for (const Entry& entry : entries_) {
    std::map<std::uint64_t, std::set<Result>> mine;  // a voter has one vote for each different result
    for (const std::vector<Sample>& block : entry.contestant->blocks()) {
      for (const Sample& sample : block) mine[sample.number].insert(resultOf(sample));
    }
    for (const auto& [number, results] : mine) {
      if (entry.decides) reference.emplace(number, *results.begin());
      for (const Result& result : results) votes[number][result] += entry.votes ? 1 : 0;
    }
  }
  for (const auto& [number, results] : votes) {
    const Result* result = elected(results);
    if (result && reference.count(number) == 0) reference[number] = *result;
  }

  std::vector<Score> scores;
  for (const Entry& entry : entries_) {
    Score score = timesOf(entry.contestant->blocks());
    score.correct = true;
    std::uint64_t lowest = ~std::uint64_t{0};
    for (const std::vector<Sample>& block : entry.contestant->blocks()) {
      for (const Sample& sample : block) {
        if (sample.number < lowest)
          lowest = sample.number, score.count = sample.count, score.checksum = sample.checksum;
        const auto found = reference.find(sample.number);
        if (found == reference.end()) continue;
        ++score.compared;
        if (found->second != resultOf(sample)) score.correct = false;
      }
    }
    score.correct = score.correct && score.compared > 0;
    scores.push_back(score);
  }
  return scores;
}

const char* remarkOn(const Score& score, const std::string& status) {
  if (status != "ok") return status.c_str();
  return score.compared == 0 ? "not compared: no majority of at least two other peers" : score.correct ? "" : "WRONG";
}

}  // namespace bench
}  // namespace hgrid
