// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "bench/measure/sample.h"
#include "bench/singles/single_peer.h"

namespace hgrid {
namespace bench {

/// What a step does with one box.
enum class StepKind {
  update,         ///< moves the box
  update_query,   ///< moves the box and asks what it overlaps
  replace_query,  ///< removes the box, inserts it at its new place, and asks what it overlaps
};
constexpr StepKind kStepKinds[] = {StepKind::update, StepKind::update_query, StepKind::replace_query};
const char* name(StepKind kind);

/// The same steps for all peers: in each, one box moves a little from where the last step left it.
struct SingleSteps {
  std::vector<Aabb> start;  ///< the boxes before the first step
  std::vector<ProxyId> ids;
  std::vector<Aabb> boxes;

  /// Makes `count` steps. A box moves by up to a tenth of its longest side on each axis.
  SingleSteps(std::vector<Aabb> start, std::size_t count);
};

/// Finds by brute force what the boxes of the first steps overlap: the result of the sample with number 0.
Sample expectedOf(const SingleSteps& steps);

/// Runs a peer step by step. First it checks some steps (sample 0, which is not timed). Then it times samples of kChunk
/// steps. A sample of updates alone ends with one query, so that no peer can put its work off for ever.
class SinglesPlay {
 public:
  static constexpr std::size_t kChunk = 1000, kJudged = 1000;

  SinglesPlay(std::unique_ptr<SinglePeer> peer, StepKind kind, const SingleSteps& steps);

  std::vector<Sample> operator()(double budget_ms);

 private:
  void step(std::size_t number, bool asks);
  double timedChunk();

  std::unique_ptr<SinglePeer> peer_;
  StepKind kind_;
  const SingleSteps* steps_;
  Sample result_;
  std::size_t next_ = kJudged;
  std::vector<ProxyId> found_;
};

}  // namespace bench
}  // namespace hgrid
