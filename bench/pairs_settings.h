// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "bench/options.h"
#include "bench/workload/world.h"

namespace hgrid {
namespace bench {

/// One world in which the peers must find all overlapping pairs.
struct Setting {
  std::string workload;
  std::size_t n;
  double moving;  ///< fraction of the boxes that move in a frame
  Movers movers = Movers::same;
  const char* kind = "pairs";  ///< of its records
};

/// Returns the settings that the options select. Settings whose results are compared follow each other.
std::vector<Setting> pairsSettings(const Options& options);

}  // namespace bench
}  // namespace hgrid
