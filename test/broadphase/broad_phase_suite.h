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
#ifdef HGRID_TEST_PARTITIONS
#include "src/partitions/array_grid.h"
#include "src/partitions/bit_grid.h"
#include "src/partitions/bucket_grid.h"
#include "src/partitions/hashed_grid.h"
#include "src/partitions/hashed_hgrid.h"
#include "src/partitions/kd_tree.h"
#include "src/partitions/loose_octree.h"
#include "src/partitions/mirtich_grid.h"
#include "src/partitions/sweep_array.h"
#include "src/partitions/sweep_lists.h"
#include "src/partitions/tree_grid.h"
#endif

namespace hgrid {
namespace test {

/// The broad phases that the tests broad_phase_*_test.cpp test. To test a new broad phase, add its type here. If it has
/// no default constructor or has additional settings, also specialize Maker for it.
///
/// The tests are compiled twice, to keep the time of one compilation short: for these types in broadphase_test, and
/// with HGRID_TEST_PARTITIONS for the partitions of the book in partitions_test.
#ifdef HGRID_TEST_PARTITIONS
using AllBroadPhases = ::testing::Types<book::HashedHGrid, book::HashedGrid, book::BucketGrid, book::ArrayGrid,
                                        book::BitGrid, book::MirtichGrid, book::LooseOctree, book::KdTree,
                                        book::TreeGrid, book::SweepLists, book::SweepArray>;
/// Returns how many random worlds each type is tested with. By default the partitions get a tenth of what HGrid gets.
inline int worldsToTest() {
  return std::min(countFromEnvironment("HGRID_TEST_WORLDS", 10000),
                  countFromEnvironment("HGRID_TEST_PARTITION_WORLDS", 1000));
}
/// Returns how many random operations each type is tested with.
inline int operationsToTest(int) { return countFromEnvironment("HGRID_TEST_PARTITION_OPERATIONS", 10000); }
#else
using AllBroadPhases = ::testing::Types<HGrid, BruteForce>;
inline int worldsToTest() { return countFromEnvironment("HGRID_TEST_WORLDS", 10000); }
inline int operationsToTest(int usual) { return usual; }
#endif

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

/// Creates broad phases of a type without settings.
template <class Tested>
struct PlainMaker {
  /// Creates a broad phase whose smallest cells have this edge [m]. Types without cells ignore the parameter.
  static std::unique_ptr<BroadPhase> withCells(double) { return std::make_unique<Tested>(); }
  /// Returns the cell edges [m] with which to test. For a type without cells, returns any single value.
  static std::vector<double> cells(const std::vector<double>&) { return {1.0}; }
  /// Creates a broad phase with random settings. The first parameter contains the boxes that it will store.
  static std::unique_ptr<BroadPhase> withAny(const std::vector<Aabb>&, Random&) { return std::make_unique<Tested>(); }
};

/// Creates broad phases of one type. Specialize it for a type with settings. The tests then check that the answers do
/// not depend on the settings.
template <class Tested>
struct Maker : PlainMaker<Tested> {};

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

#ifdef HGRID_TEST_PARTITIONS
inline book::CellRule anyRule(Random& random) {
  return random.chance(0.5) ? book::CellRule::objects : book::CellRule::density;
}

template <>
struct Maker<book::HashedGrid> : PlainMaker<book::HashedGrid> {
  static std::unique_ptr<BroadPhase> withAny(const std::vector<Aabb>&, Random& random) {
    const book::CellRule rule = anyRule(random);
    return std::make_unique<book::HashedGrid>(rule, random.chance(0.5));
  }
};

template <class Grid>
struct MakerWithRule : PlainMaker<Grid> {
  static std::unique_ptr<BroadPhase> withAny(const std::vector<Aabb>&, Random& random) {
    return std::make_unique<Grid>(anyRule(random));
  }
};
template <>
struct Maker<book::BucketGrid> : MakerWithRule<book::BucketGrid> {};
template <>
struct Maker<book::ArrayGrid> : MakerWithRule<book::ArrayGrid> {};
#endif

}  // namespace test
}  // namespace hgrid
