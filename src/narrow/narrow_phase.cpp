// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

const char* name(Measure status) {
  static constexpr const char* kNames[] = {"NOT_MEASURED",        "MEASURED", "CONTACT", "CONTAINED",
                                           "CONTAINMENT_UNKNOWN", "FAILED"};
  return kNames[static_cast<int>(status)];
}

}  // namespace hgrid
