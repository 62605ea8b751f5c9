// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/workload/workloads.h"

#include <algorithm>
#include <stdexcept>

#include "bench/workload/layouts.h"

namespace hgrid {
namespace bench {
namespace {

struct Workload {
  std::string name;
  bool even;
  Layout (*layout)(std::size_t n);
};

const std::vector<Workload>& all() {
  static const std::vector<Workload> workloads{
      {"uniform", true, uniformLayout},
      {"mixed", true, mixedLayout},
      {"floor", true, floorLayout},
      {"robots", true, robotsLayout},
      {"heaps2", false, [](std::size_t n) { return heapsLayout(n, 2); }},
      {"heaps64", false, [](std::size_t n) { return heapsLayout(n, 64); }},
      {"fleet", false, fleetLayout},
      {"strays", false, straysLayout},
      {"diagonal", false, diagonalLayout},
      {"levy", false, levyLayout},
      {"rods", false, rodsLayout},
      {"giants", false, giantsLayout},
      {"torus", false, torusLayout},
      {"tower", false, towerLayout},
      {"line", false, lineLayout},
      {"decades", false, decadesLayout},
      {"onecell", false, oneCellLayout},
      {"sizes", false, sizesLayout},
  };
  return workloads;
}

std::vector<std::string> names(bool even) {
  std::vector<std::string> names;
  for (const Workload& workload : all()) {
    if (workload.even == even) names.push_back(workload.name);
  }
  return names;
}

}  // namespace

const std::vector<std::string>& evenWorkloads() {
  static const std::vector<std::string> even = names(true);
  return even;
}

const std::vector<std::string>& unevenWorkloads() {
  static const std::vector<std::string> uneven = names(false);
  return uneven;
}

bool isEven(const std::string& workload) {
  return std::find(evenWorkloads().begin(), evenWorkloads().end(), workload) != evenWorkloads().end();
}

Layout layoutOf(const std::string& workload, std::size_t n) {
  for (const Workload& known : all()) {
    if (known.name == workload) return known.layout(n);
  }
  throw std::invalid_argument("there is no workload " + workload);
}

}  // namespace bench
}  // namespace hgrid
