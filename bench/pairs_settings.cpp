// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/pairs_settings.h"

#include <algorithm>

#include "bench/workload/workloads.h"

namespace hgrid {
namespace bench {
namespace {

bool isIn(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> usualWorkloads(const Options& options) {
  std::vector<std::string> names = evenWorkloads();
  const std::vector<std::string> few{"fleet", "strays", "line", "sizes"};
  const std::vector<std::string>& uneven = options.quick ? few : unevenWorkloads();
  names.insert(names.end(), uneven.begin(), uneven.end());
  return names;
}

/// Returns the fractions of the boxes that move in a frame. In uneven worlds all boxes move by default. If different
/// boxes move in each frame, the fraction 1 is left out.
std::vector<double> fractions(const Options& options, const std::string& workload, Movers movers) {
  std::vector<double> moving = options.moving;
  if (moving.empty()) moving = isEven(workload) ? std::vector<double>{1.0, 0.1, 0.01} : std::vector<double>{1.0};
  if (movers == Movers::changing) moving.erase(std::remove(moving.begin(), moving.end(), 1.0), moving.end());
  return moving;
}

bool asked(const Options& options, const std::string& workload, std::size_t n, Movers movers) {
  if (!options.movers.empty()) return isIn(options.movers, name(movers));
  if (movers == Movers::same) return true;
  return n == 100000 && (workload == "uniform" || (!options.quick && (workload == "mixed" || workload == "robots")));
}

}  // namespace

std::vector<Setting> pairsSettings(const Options& options) {
  std::vector<std::size_t> sizes{1000, 10000, 100000, 1000000};
  if (options.quick) sizes.pop_back();
  if (!options.sizes.empty()) sizes = options.sizes;
  std::vector<Setting> settings;
  for (const std::size_t n : sizes) {
    for (const std::string& workload : options.boxWorkloads(usualWorkloads(options))) {
      const bool too_small = options.quick && n < 10000 && !isEven(workload);
      if (too_small && options.workloads.empty()) continue;
      for (const Movers movers : {Movers::same, Movers::changing}) {
        if (!asked(options, workload, n, movers)) continue;
        for (const double moving : fractions(options, workload, movers))
          settings.push_back({workload, n, moving, movers});
      }
    }
  }
  return settings;
}

}  // namespace bench
}  // namespace hgrid
