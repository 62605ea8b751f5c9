// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/exactness/exactness_pairs.h"
#include "bench/exactness/exactness_tally.h"
#include "bench/exactness/forked_answers.h"
#include "bench/parts.h"

namespace hgrid {
namespace bench {
namespace {

/// The answers of all peers about one world, and what is true of it.
class ExactnessPlay {
 public:
  ExactnessPlay(const ExactnessWorld& world, std::size_t count) : world_(world), pairs_(world.pairs(count)) {
    for (const test::Case& placed : pairs_) {
      truths_.emplace_back(placed, world.size);
      unsure_ += !truths_.back().isSure();
      shortest_.push_back(truths_.back().moveAlongAxes());
    }
  }

  void ask(const ExactnessPeer& peer) {
    Asked asked{peer, forkedAnswers(peer, pairs_), {}};
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      asked.moves.push_back(moveOf(asked.answers[i], truths_[i]));
      if (!std::isnan(asked.moves[i])) shortest_[i] = std::min(shortest_[i], asked.moves[i]);
    }
    asked_.push_back(std::move(asked));
  }

  void record(const Options& options, std::vector<Record>& records) const {
    for (const Asked& asked : asked_) {
      if (!options.peer(asked.peer.name)) continue;
      ExactnessTally tally(world_.size);
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        if (!truths_[i].isSure() || !asked.peer.knows(pairs_[i])) continue;
        tally.add(asked.answers[i], truths_[i], asked.moves[i], shortest_[i]);
      }
      Record record("exactness");
      record.text("peer", asked.peer.name).text("shapes", world_.shapes()).number("size", world_.size);
      record.number("unsure", static_cast<double>(unsure_));
      tally.describe(record);
      records.push_back(record);
    }
  }

 private:
  struct Asked {
    ExactnessPeer peer;
    std::vector<ExactnessAnswer> answers;
    std::vector<double> moves;  // [m] NaN: the answer has no depth
  };

  /// Returns how far the second shape must be moved along the normal of the answer, at least by its depth, until it is
  /// apart from the first one. The normal of shapes that are apart counts, too: it may show how little they overlap.
  static double moveOf(const ExactnessAnswer& answer, const ExactnessWitness& truth) {
    const double unknown = ExactnessAnswer::kUnknown;
    if (!answer.given || !truth.isSure() || !truth.overlap() || !answer.normal.allFinite()) return unknown;
    if (answer.touches && !std::isfinite(answer.depth)) return unknown;
    return truth.separatingMove(answer.normal.normalized(), answer.touches ? std::max(answer.depth, 0.0) : 0.0);
  }

  ExactnessWorld world_;
  std::vector<test::Case> pairs_;
  std::vector<ExactnessWitness> truths_;
  std::vector<double> shortest_;  // [m] for each pair, the shortest move that separates the shapes and is known
  std::size_t unsure_ = 0;
  std::vector<Asked> asked_;
};

}  // namespace

void runExactness(const Options& options, std::vector<Record>& records) {
  const std::size_t count = !options.sizes.empty() ? options.sizes.front() : options.quick ? 500 : 5000;
  std::printf("\nexactness of distances, touches and depths: %zu pairs of each size and class\n", count);
  for (const ExactnessWorld& world : exactnessWorlds()) {
    ExactnessPlay play(world, count);
    for (const ExactnessPeer& peer : exactnessPeers()) play.ask(peer);  // all: each may know the shortest move
    play.record(options, records);
    std::printf("  %s shapes of %g m\n", world.shapes().c_str(), world.size);
    std::fflush(stdout);
  }
}

}  // namespace bench
}  // namespace hgrid
