// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/fcl.h"
#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace test {

NarrowPhase& narrowPhase() {
  static const std::shared_ptr<NarrowPhase> shared = makeFclNarrowPhase();
  return *shared;
}

bool testsMeshes() { return false; }

}  // namespace test
}  // namespace hgrid
