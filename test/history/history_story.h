// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// Returns everything that queries and explanations say about a snapshot, and its numbers, as texts and bytes. Two
/// snapshots with equal texts are not told apart by any user. Does not compare broad phases and events.
/// @param seed  chooses the queries
std::string toldBy(const Snapshot& snapshot, NarrowPhase& narrow_phase, unsigned seed);

/// A random world that changes: bodies come, go, move and grow old, cells of maps are replaced, rules change, and
/// sources lack something for a while.
class ChangingWorld {
 public:
  ChangingWorld(unsigned seed, std::shared_ptr<NarrowPhase> narrow_phase);

  /// Makes random changes, then the next tick. Ticks are 20 ms apart, and some have the stamp of the tick before.
  std::shared_ptr<const Snapshot> tick();
  Scene& scene() { return scene_; }

 private:
  static SceneOptions optionsOf(Random& random);
  void change();
  void changeCells(BodyId id);

  Random random_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  Scene scene_;
  std::map<std::string, BodyId> ids_;
  std::vector<SourceGap> gaps_;
  Time stamp_{1000000000};
};

}  // namespace test
}  // namespace hgrid
