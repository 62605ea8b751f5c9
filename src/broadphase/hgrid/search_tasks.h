// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "broadphase/hgrid/layer.h"

namespace hgrid {

/// A part of a search for pairs. There are two kinds of tasks:
///
/// - A range of positions (see Layer) of one level. The task tests the boxes at these positions against the later boxes
///   of this level, or against all boxes of another level.
/// - A range of regions of a layer. The task tests the boxes in these regions against each other and against later
///   regions, or against all boxes of another layer.
struct SearchTask {
  static constexpr std::uint32_t kBoxes = 1024;  // boxes per task; a multiple of kBlock in output_body.h

  const kernels::Level* asking;  // level of the positions
  const kernels::Level* asked;   // the other level; null: the same level
  std::uint32_t begin, end;      // range of positions or of indices of regions
  const Layer* layer = nullptr;  // layer of the regions; null: the task has positions
  const Layer* other = nullptr;  // the other layer; null: the same layer
  std::size_t boxes = 0;         // number of boxes in the range
  // The result of the task: `found` pairs from index `first` on in SearchBuffers::parts[thread].
  std::size_t thread = 0, first = 0, found = 0;
  std::size_t to = 0;  // index of the task's first pair in the result of the search
};

/// Adds tasks that find the pairs of a layer's boxes with each other.
void addWithin(std::vector<SearchTask>& tasks, const Layer& layer);
/// Adds tasks that find the pairs of the boxes of two layers.
void addAcross(std::vector<SearchTask>& tasks, const Layer& a, const Layer& b);

/// Decides in which direction two levels are tested. Returns true if testing boxes of `first` against the cells of
/// `second` visits fewer rows of cells than testing boxes of `second` against the cells of `first`.
/// @param boxes, others  numbers of boxes of `first` and of `second` that would be tested
bool firstAsks(const kernels::Level& first, std::size_t boxes, const kernels::Level& second, std::size_t others);

}  // namespace hgrid
