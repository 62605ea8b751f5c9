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

/// The values of a line that a test by the slabs of boxes needs on one axis (Ericson 2005, 5.3.3). The fractions of the
/// line at which it enters and leaves a slab are a face of the box times `inverse`, minus a constant. The constants
/// also grow the box by the radius of the line.
///
/// The test computes in float. The boxes are grown further to allow for the rounding, by 1e-6 of the sum of the line's
/// coordinates: a fraction between -1 and 1 is rounded by less. So the test never rejects a box that touches the line.
/// Where the line moves along an axis by less than 1e-9 of the sum, `inverse` is that of 1e-9 of the sum. The growth
/// allows for this, too. So no value is NaN.
struct Slab {
  Simd::Lanes inverse, enter, leave;
  std::uint32_t entered, left;  // indices in TreeBlock::bounds of the faces that the line enters and leaves
};

/// @param around  [m] how much boxes are grown
/// @param most  [1/m] bound of the inverse
inline Slab slabOf(double from, double to, std::uint32_t axis, float around, float most) {
  const double step = to - from;
  const float exact = 1.0f / static_cast<float>(magnitude(step)), size = exact < most ? exact : most;
  const float inverse = __builtin_copysignf(size, static_cast<float>(step));
  const float start = static_cast<float>(from) * inverse, grown = around * size;
  const std::uint32_t back = inverse < 0.0f ? 3 : 0;  // added to an index, because a branch would be mispredicted
  return {Simd::lanesOf(inverse), Simd::lanesOf(start + grown), Simd::lanesOf(start - grown), axis + back,
          axis + 3 - back};
}

/// Returns the fractions at which the line enters kWidth boxes of a block, from lane j on.
inline Simd::Lanes entries(const Slab& slab, const TreeBlock& block, std::uint32_t j) {
  return Simd::timesMinus(Simd::lanesAt(block.bounds[slab.entered] + j), slab.inverse, slab.enter);
}
/// Returns the fractions at which the line leaves kWidth boxes of a block, from lane j on.
inline Simd::Lanes exits(const Slab& slab, const TreeBlock& block, std::uint32_t j) {
  return Simd::timesMinus(Simd::lanesAt(block.bounds[slab.left] + j), slab.inverse, slab.leave);
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
  std::uint32_t waiting[2 * TreeBlock::kBoxes * BoxTree::kMostDepth];  // inner nodes to visit
  std::uint32_t* end = waiting;
  std::uint32_t node = tree.root;
  if ((node & 1u) != 0) return searchLeaf(tree, node >> 2, test, found);
  for (;;) {
    const TreeBlock* block = tree.inner + (node >> 2);
    const TreeBlock* const last = block + (node >> 1 & 1u);
    for (; block <= last; ++block) {
      for (std::uint32_t j = 0; j < TreeBlock::kBoxes; j += Simd::kWidth) {
        for (std::uint32_t bits = test(*block, j); bits != 0; bits &= bits - 1) {
          const std::uint32_t below = block->below[j + static_cast<std::uint32_t>(__builtin_ctz(bits))];
          if ((below & 1u) != 0) {
            searchLeaf(tree, below >> 2, test, found);
          } else {
            *end++ = below;
            for (const float* bound : tree.inner[below >> 2].bounds) __builtin_prefetch(bound);
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
  searchTree(*tree, *box, sink);
}

void nearInTree(const BoxTree* tree, const double* center, double radius, PositionSink* sink) {
  const double sum = magnitude(center[0]) + magnitude(center[1]) + magnitude(center[2]) + radius;
  const auto grown = static_cast<float>(radius + (3e-7 * sum + 1e-37));  // allows for the rounding to float
  const auto x = static_cast<float>(center[0]), y = static_cast<float>(center[1]), z = static_cast<float>(center[2]);
  searchTree(*tree, {{x - grown, y - grown, z - grown}, {x + grown, y + grown, z + grown}}, sink);
}

bool alongInTree(const BoxTree* tree, const double* from, const double* to, double radius, PositionSink* sink) {
  double sum = radius + 1e-20;
  for (int axis = 0; axis < 3; ++axis) sum += magnitude(from[axis]) + magnitude(to[axis]);
  if (!(sum < 1e30)) return false;
  const auto around = static_cast<float>(radius + 2e-6 * sum), most = 1e9f / static_cast<float>(sum);
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
