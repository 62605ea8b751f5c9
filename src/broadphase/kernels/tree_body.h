// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Searches a BoxTree.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/line_filter_body.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

/// The values of a line that a test by the slabs of boxes needs on one axis (Ericson 2005, 5.3.3). A line enters and
/// leaves a slab at the fractions (face - start) * inverse - constant of its length. The constants grow the box by the
/// radius of the line, and correct the rounding of `start`.
///
/// The test computes in float, so the boxes are grown further, to allow for rounding. The subtraction comes first:
/// where a fraction is between 0 and 1, the difference is at most the length of the line on this axis plus the growth.
/// So it is enough to grow the boxes by 1e-6 of that length and of the radius, however far the line is from the origin.
/// Where the line moves along an axis by less than 1e-12 of the sum of its coordinates, `inverse` is that of 1e-12 of
/// the sum. The boxes are grown by four times as much, which allows for this. So no value is NaN, and the test never
/// rejects a box that touches the line.
struct Slab {
  Simd::Lanes start, inverse, enter, leave;
  std::uint32_t entered, left;  // indices in TreeBlock::bounds of the faces that the line enters and leaves
};

/// @param around  [m] the radius of the line, grown
/// @param most  [1/m] bound of the inverse
inline Slab slabOf(double from, double to, std::uint32_t axis, float around, float most) {
  const float start = static_cast<float>(from), step = static_cast<float>(to - from);
  const float length = __builtin_fabsf(step), exact = 1.0f / length, size = exact < most ? exact : most;
  const float inverse = __builtin_copysignf(size, step),
              rest = static_cast<float>(from - static_cast<double>(start)) * inverse;
  const float grown = (around + 1e-6f * length) * size;
  const std::uint32_t back = inverse < 0.0f ? 3 : 0;  // added to an index, because a branch would be mispredicted
  return {Simd::lanesOf(start), Simd::lanesOf(inverse), Simd::lanesOf(rest + grown), Simd::lanesOf(rest - grown),
          axis + back,          axis + 3 - back};
}

/// Returns the fractions at which the line enters kWidth boxes of a block, from lane j on.
inline Simd::Lanes entries(const Slab& slab, const TreeBlock& block, std::uint32_t j) {
  const Simd::Lanes away = Simd::minus(Simd::lanesAt(block.bounds[slab.entered] + j), slab.start);
  return Simd::timesMinus(away, slab.inverse, slab.enter);
}
/// Returns the fractions at which the line leaves kWidth boxes of a block, from lane j on.
inline Simd::Lanes exits(const Slab& slab, const TreeBlock& block, std::uint32_t j) {
  const Simd::Lanes away = Simd::minus(Simd::lanesAt(block.bounds[slab.left] + j), slab.start);
  return Simd::timesMinus(away, slab.inverse, slab.leave);
}

/// Writes the slots of the boxes of a leaf that pass the test.
template <class Test>
inline __attribute__((always_inline)) void searchLeaf(const BoxTree& tree, std::uint32_t leaf, const Test& test,
                                                      Output<std::uint32_t>& found) {
  for (std::uint32_t j = 0; j < TreeBlock::kBoxes; j += Simd::kWidth) {
    found.wrote(Simd::storePositions(found.room(), leaf * TreeBlock::kBoxes + j, test(tree.leaves[leaf], j)));
  }
}

/// Writes the slots of the boxes that pass the test.
/// @param test  called as uint32_t test(const TreeBlock&, lane). Bit k of the result says whether the box in lane + k
///              passes.
template <class Test>
inline __attribute__((always_inline)) void searchTree(const BoxTree& tree, const Test& test,
                                                      Output<std::uint32_t>& found) {
  std::uint32_t waiting[TreeBlock::kBoxes * BoxTree::kMostDepth];  // inner nodes to visit
  std::uint32_t* end = waiting;
  std::uint32_t node = tree.root;
  if ((node & BoxTree::kLeaf) != 0) return searchLeaf(tree, node >> BoxTree::kShift, test, found);
  for (;;) {
    const TreeBlock* block = tree.inner + (node >> BoxTree::kShift);
    const TreeBlock* const last = block + ((node & BoxTree::kTwoBlocks) != 0 ? 1 : 0);
    for (; block <= last; ++block) {
      for (std::uint32_t j = 0; j < TreeBlock::kBoxes; j += Simd::kWidth) {
        for (std::uint32_t bits = test(*block, j); bits != 0; bits &= bits - 1) {
          const std::uint32_t below = block->below[j + static_cast<std::uint32_t>(__builtin_ctz(bits))];
          if ((below & BoxTree::kLeaf) != 0) {
            searchLeaf(tree, below >> BoxTree::kShift, test, found);
          } else {
            *end++ = below;
            for (const float* bound : tree.inner[below >> BoxTree::kShift].bounds) __builtin_prefetch(bound);
          }
        }
      }
    }
    if (end == waiting) return;
    node = *--end;
  }
}

/// Writes the slots of the boxes that overlap `query`.
inline __attribute__((always_inline)) void searchTree(const BoxTree& tree, const Box& box, PositionSink* sink) {
  const Simd::Box query = Simd::boxOf(box);
  Output<std::uint32_t> found(sink);
  searchTree(
      tree,
      [query](const TreeBlock& block, std::uint32_t j) {
        return Simd::overlaps(query, Columns{block.bounds[0], TreeBlock::kBoxes}, j, Simd::kWidth);
      },
      found);
  found.close();
}

void overlappingInTree(const BoxTree* tree, const Box* box, PositionSink* sink) {
  Box finite;  // an infinite box would overlap the unused lanes of blocks
  for (int axis = 0; axis < 3; ++axis) {
    finite.min[axis] = box->min[axis] > -kMostFloat ? box->min[axis] : -kMostFloat;
    finite.max[axis] = box->max[axis] < kMostFloat ? box->max[axis] : kMostFloat;
  }
  searchTree(*tree, finite, sink);
}

bool nearInTree(const BoxTree* tree, const double* center, double radius, PositionSink* sink) {
  constexpr float kRounding = 2.5e-7f, kLeast = 1e-37f;  // allow for the rounding to float
  const double sum = magnitude(center[0]) + magnitude(center[1]) + magnitude(center[2]) + radius;
  if (!(sum < 1e30)) return false;
  const auto r = static_cast<float>(radius + 4e-12 * sum);
  const auto x = static_cast<float>(center[0]), y = static_cast<float>(center[1]), z = static_cast<float>(center[2]);
  const float rx = r + ((__builtin_fabsf(x) + r) * kRounding + kLeast),
              ry = r + ((__builtin_fabsf(y) + r) * kRounding + kLeast),
              rz = r + ((__builtin_fabsf(z) + r) * kRounding + kLeast);
  searchTree(*tree, {{x - rx, y - ry, z - rz}, {x + rx, y + ry, z + rz}}, sink);
  return true;
}

bool alongInTree(const BoxTree* tree, const double* from, const double* to, double radius, PositionSink* sink) {
  double sum = radius + 1e-20;
  for (int axis = 0; axis < 3; ++axis) sum += magnitude(from[axis]) + magnitude(to[axis]);
  if (!(sum < 1e30)) return false;
  const auto around = static_cast<float>(1.000001 * radius + 4e-12 * sum), most = 1e12f / static_cast<float>(sum);
  const Slab x = slabOf(from[0], to[0], 0, around, most), y = slabOf(from[1], to[1], 1, around, most),
             z = slabOf(from[2], to[2], 2, around, most);
  Output<std::uint32_t> found(sink);
  searchTree(
      *tree,
      [x, y, z](const TreeBlock& block, std::uint32_t j) {
        const Simd::Lanes first = Simd::higher(Simd::higher(entries(x, block, j), entries(y, block, j)),
                                               Simd::higher(entries(z, block, j), Simd::lanesOf(0.0f)));
        const Simd::Lanes last = Simd::lower(Simd::lower(exits(x, block, j), exits(y, block, j)),
                                             Simd::lower(exits(z, block, j), Simd::lanesOf(1.0f)));
        return Simd::bitsOf(Simd::notGreater(first, last), Simd::kWidth);
      },
      found);
  found.close();
  return true;
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
