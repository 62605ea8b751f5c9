// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Searches a BoxTree.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

// Each query has two types: the numbers in memory, and a test that has copies of them in registers, one number in all
// lanes. The functions that compute the numbers are not inlined. So the copies are made from memory, which does not use
// the units that compute, and the numbers of all axes are computed together: compilers turn loops over four numbers
// into vector operations. A query that ends at the root takes clearly less time then.

/// A box, grown to allow for rounding. The fourth numbers are not used.
struct BoxNumbers {
  alignas(16) float min[4], max[4];  // [m]
};

/// Tests boxes for overlap with a box.
class BoxTest {
 public:
  using Numbers = BoxNumbers;
  static constexpr bool kVisitsManyNodes = false;  // usually one after the other, so prefetching them takes only time
  explicit BoxTest(const BoxNumbers& box) : box_(Simd::boxOf(box.min, box.max)) {}
  /// Tests kWidth boxes of a block, from lane j on. Bit k of the result says whether the box in lane j + k passes.
  std::uint32_t operator()(const TreeBlock& block, std::uint32_t j) const {
    return Simd::overlaps(box_, Columns{block.bounds[0], TreeBlock::kBoxes}, j, Simd::kWidth);
  }

 private:
  Simd::Box box_;
};

/// The numbers of a line that a test by the slabs of boxes needs (Ericson 2005, 5.3.3). A line enters and leaves a slab
/// at the fractions (face - start) * inverse of its length, minus and plus `grown`. The fourth numbers are not used.
///
/// `grown` contains the radius, and allows for the rounding of the other numbers and of the test, which computes in
/// float. The subtraction comes first: where a fraction is between 0 and 1, the difference is at most the length of the
/// line on this axis plus the growth. So it is enough to grow the boxes by 1e-6 of that length, by 1e-6 of the radius
/// and by the rounding error of `start`. Where the line moves by less than 1e-18 m along an axis, `inverse` is that of
/// 1e-18 m, and the boxes are grown by four times as much. All numbers are finite. So the test never rejects a box that
/// touches the line, and never accepts an unused lane.
struct LineNumbers {
  alignas(16) float start[4];                    // [m]
  alignas(16) float inverse[4];                  // [1/m]
  alignas(16) float grown[4];                    // fraction of the line
  alignas(16) std::int32_t entered[4], left[4];  // indices in TreeBlock::bounds of the faces of lane 0
};

/// Tests boxes for contact with a line.
class LineTest {
 public:
  using Numbers = LineNumbers;
  static constexpr bool kVisitsManyNodes = true;
  explicit LineTest(const LineNumbers& line) : x_(line, 0), y_(line, 1), z_(line, 2) {}
  /// Works like BoxTest.
  std::uint32_t operator()(const TreeBlock& block, std::uint32_t j) const {
    const float* bounds = block.bounds[0] + j;
    const Simd::Lanes first = Simd::higher(Simd::higher(x_.entries(bounds), y_.entries(bounds)),
                                           Simd::higher(z_.entries(bounds), Simd::lanesOf(0.0f)));
    const Simd::Lanes last = Simd::lower(Simd::lower(x_.exits(bounds), y_.exits(bounds)),
                                         Simd::lower(z_.exits(bounds), Simd::lanesOf(1.0f)));
    return Simd::bitsOf(Simd::notGreater(first, last), Simd::kWidth);
  }

 private:
  struct Slab {
    Slab(const LineNumbers& line, int axis)
        : start(Simd::lanesOf(line.start[axis])),
          inverse(Simd::lanesOf(line.inverse[axis])),
          grown(Simd::lanesOf(line.grown[axis])),
          entered(line.entered[axis]),
          left(line.left[axis]) {}
    /// Returns the fractions at which the line enters the slabs of kWidth boxes.
    Simd::Lanes entries(const float* bounds) const {
      return Simd::timesMinus(Simd::minus(Simd::lanesAt(bounds + entered), start), inverse, grown);
    }
    /// Returns the fractions at which the line leaves the slabs of kWidth boxes.
    Simd::Lanes exits(const float* bounds) const {
      return Simd::timesPlus(Simd::minus(Simd::lanesAt(bounds + left), start), inverse, grown);
    }
    Simd::Lanes start, inverse, grown;
    std::int32_t entered, left;
  };
  Slab x_, y_, z_;
};

/// Returns which boxes of a block pass: bit k is that of lane k.
template <class Test>
inline __attribute__((always_inline)) std::uint32_t passing(const TreeBlock& block, const Test& test) {
  std::uint32_t bits = 0;
  for (std::uint32_t j = 0; j < TreeBlock::kBoxes; j += Simd::kWidth) bits |= test(block, j) << j;
  return bits;
}

/// Writes the slots of the boxes of a leaf that pass.
template <class Test>
inline __attribute__((always_inline)) void searchLeaf(const BoxTree& tree, std::uint32_t leaf, const Test& test,
                                                      Output<std::uint32_t>& found) {
  for (std::uint32_t j = 0; j < TreeBlock::kBoxes; j += Simd::kWidth) {
    found.wrote(Simd::storePositions(found.room(), leaf * TreeBlock::kBoxes + j, test(tree.leaves[leaf], j)));
  }
}

/// Returns which boxes of an inner node pass: bit k is that of lane k % kBoxes of block k / kBoxes.
template <class Test>
inline __attribute__((always_inline)) std::uint32_t passing(const BoxTree& tree, std::uint32_t node, const Test& test) {
  const TreeBlock* const blocks = tree.inner + (node >> BoxTree::kShift);
  std::uint32_t bits = passing(blocks[0], test);
  if ((node & BoxTree::kTwoBlocks) != 0) bits |= passing(blocks[1], test) << TreeBlock::kBoxes;
  return bits;
}

/// Searches all nodes below the root, which must not be a leaf. Not inlined, see searchTree().
/// @param bits  which boxes of the root pass
template <class Test>
__attribute__((noinline)) void searchNodes(const BoxTree& tree, std::uint32_t bits, const typename Test::Numbers& query,
                                           PositionSink* sink) {
  const Test test(query);
  Output<std::uint32_t> found(sink);
  // Inner nodes to visit. The root adds up to 2 * kBoxes, each other node takes one away and adds up to kBoxes.
  std::uint32_t waiting[TreeBlock::kBoxes * BoxTree::kMostDepth];
  static_assert(2 * TreeBlock::kBoxes + (TreeBlock::kBoxes - 1) * (BoxTree::kMostDepth - 2) <= sizeof waiting / 4,
                "a path of inner nodes below the root has at most kMostDepth - 2 of them");
  std::uint32_t* end = waiting;
  for (std::uint32_t node = tree.root;;) {
    const TreeBlock* const blocks = tree.inner + (node >> BoxTree::kShift);
    for (; bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::uint32_t>(__builtin_ctz(bits));
      const std::uint32_t below = blocks[k / TreeBlock::kBoxes].below[k % TreeBlock::kBoxes];
      if ((below & BoxTree::kLeaf) != 0) {
        searchLeaf(tree, below >> BoxTree::kShift, test, found);
      } else {
        *end++ = below;
        if (Test::kVisitsManyNodes) {
          for (const float* bound : tree.inner[below >> BoxTree::kShift].bounds) __builtin_prefetch(bound);
        }
      }
    }
    if (end == waiting) break;
    node = *--end;
    bits = passing(tree, node, test);
  }
  found.close();
}

/// Searches a tree that is one leaf.
template <class Test>
__attribute__((noinline)) void searchOnlyLeaf(const BoxTree& tree, const typename Test::Numbers& query,
                                              PositionSink* sink) {
  Output<std::uint32_t> found(sink);
  searchLeaf(tree, tree.root >> BoxTree::kShift, Test(query), found);
  found.close();
}

/// Writes the slots of the boxes that pass. The root is tested first. If none of its boxes passes, that is all, and
/// there is no time spent on what the search of other nodes needs.
template <class Test>
inline __attribute__((always_inline)) void searchTree(const BoxTree& tree, const typename Test::Numbers& query,
                                                      PositionSink* sink) {
  if ((tree.root & BoxTree::kLeaf) != 0) return searchOnlyLeaf<Test>(tree, query, sink);
  const std::uint32_t bits = passing(tree, tree.root, Test(query));
  if (bits != 0) searchNodes<Test>(tree, bits, query, sink);
}

void overlappingInTree(const BoxTree* tree, const Box* box, PositionSink* sink) {
  BoxNumbers finite;  // an infinite box would overlap the unused lanes of blocks
  for (int axis = 0; axis < 3; ++axis) {
    finite.min[axis] = box->min[axis] > -kMostFloat ? box->min[axis] : -kMostFloat;
    finite.max[axis] = box->max[axis] < kMostFloat ? box->max[axis] : kMostFloat;
  }
  searchTree<BoxTest>(*tree, finite, sink);
}

/// Computes the box around a sphere. The factors allow for the rounding to float.
__attribute__((noinline)) void boxAround(const double* sphere, float slack, BoxNumbers* box) {
  float numbers[4];  // the center and the radius
  for (int i = 0; i < 4; ++i) numbers[i] = static_cast<float>(sphere[i]);
  const float radius = 1.0000005f * numbers[3];
  for (int i = 0; i < 4; ++i) {
    const float grown = (2.5e-7f * __builtin_fabsf(numbers[i]) + slack) + radius;
    box->min[i] = numbers[i] - grown;
    box->max[i] = numbers[i] + grown;
  }
}

bool nearInTree(const BoxTree* tree, const double* sphere, PositionSink* sink) {
  if (!(sphere[3] < 1e30)) return false;
  BoxNumbers box;
  boxAround(sphere, tree->slack, &box);
  searchTree<BoxTest>(*tree, box, sink);
  return true;
}

/// Computes the numbers of a line. @returns false if a number would not be finite
__attribute__((noinline)) bool numbersOf(const double* segment, LineNumbers* line) {
  const double *const from = segment, *const to = segment + 3;  // the fourth numbers are there, but have no meaning
  float start[4], step[4], slack[4];                            // slack: a part of the allowance of the exact test
  for (int i = 0; i < 4; ++i) start[i] = static_cast<float>(from[i]);
  for (int i = 0; i < 4; ++i) step[i] = static_cast<float>(to[i] - from[i]);
  for (int i = 0; i < 4; ++i) slack[i] = 8.2e-12f * __builtin_fabsf(start[i]) + 4.1e-12f * __builtin_fabsf(step[i]);
  const float radius = 1.000001f * static_cast<float>(segment[6]) + 4e-18f;
  const float around = (radius + slack[2]) + (slack[0] + slack[1]);
  if (!(around < 1e12f)) return false;
  for (int i = 0; i < 4; ++i) {
    const float length = __builtin_fabsf(step[i]), exact = 1.0f / length, size = exact < 1e18f ? exact : 1e18f;
    line->start[i] = start[i];
    line->inverse[i] = __builtin_copysignf(size, step[i]);
    line->grown[i] = (around + (1e-6f * length + 6.1e-8f * __builtin_fabsf(start[i]))) * size;
  }
  for (int i = 0; i < 4; ++i) {
    const bool back = line->inverse[i] < 0.0f;
    line->entered[i] = (back ? i + 3 : i) * static_cast<std::int32_t>(TreeBlock::kBoxes);
    line->left[i] = (back ? i : i + 3) * static_cast<std::int32_t>(TreeBlock::kBoxes);
  }
  return true;
}

bool alongInTree(const BoxTree* tree, const double* segment, PositionSink* sink) {
  LineNumbers line;
  if (!numbersOf(segment, &line)) return false;
  searchTree<LineTest>(*tree, line, sink);
  return true;
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
