// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cxxabi.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "test/support/brute_force.h"
#include "test/support/grids.h"

namespace hgrid {
namespace test {

/// The broad phases that the tests broad_phase_*_test.cpp test. To test a new broad phase, add its type here. If it has
/// no default constructor or has additional settings, also specialize Maker for it.
using AllBroadPhases = ::testing::Types<HGrid, BruteForce>;

/// Returns the type names that googletest uses in the names of tests.
struct BroadPhaseNames {
  template <class Tested>
  static std::string GetName(int) {
    const std::unique_ptr<char, void (*)(void*)> full(
        abi::__cxa_demangle(typeid(Tested).name(), nullptr, nullptr, nullptr), std::free);
    const std::string name = full.get();
    return name.substr(name.rfind(':') + 1);
  }
};

/// Creates broad phases of one type. Specialize it for a type with settings. The tests then check that the answers do
/// not depend on the settings.
template <class Tested>
struct Maker {
  /// Creates a broad phase whose smallest cells have this edge [m]. Types without cells ignore the parameter.
  static std::unique_ptr<BroadPhase> withCells(double) { return std::make_unique<Tested>(); }
  /// Returns the cell edges [m] with which to test. For a type without cells, returns any single value.
  static std::vector<double> cells(const std::vector<double>&) { return {1.0}; }
  /// Creates a broad phase with random settings. The first parameter contains the boxes that it will store.
  static std::unique_ptr<BroadPhase> withAny(const std::vector<Aabb>&, Random&) { return std::make_unique<Tested>(); }
};

template <>
struct Maker<HGrid> {
  static std::unique_ptr<BroadPhase> withCells(double edge) {
    GridScale scale;
    scale.finest_edge = edge;
    return std::make_unique<HGrid>(scale);
  }
  static std::vector<double> cells(const std::vector<double>& edges) { return edges; }
  static std::unique_ptr<BroadPhase> withAny(const std::vector<Aabb>& boxes, Random& random) {
    auto grid = std::make_unique<HGrid>(scaleFor(boxes, random));
    const std::vector<Isa> isas = supportedIsas();
    grid->setIsa(isas[std::size_t(random.below(int(isas.size())))]);
    return grid;
  }
};

}  // namespace test
}  // namespace hgrid
