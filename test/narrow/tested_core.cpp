// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace test {

NarrowPhase& narrowPhase() {
  static const std::shared_ptr<NarrowPhase> shared = makeCoreNarrowPhase();
  return *shared;
}

bool testsMeshes() { return true; }

}  // namespace test
}  // namespace hgrid
