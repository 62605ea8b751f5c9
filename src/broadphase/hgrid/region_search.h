// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "broadphase/hgrid/layer.h"
#include "broadphase/hgrid/position_writer.h"

namespace hgrid {

/// Copies of boxes of one level: all boxes that may overlap boxes of another level.
struct GatheredBoxes {
  std::vector<std::uint32_t> levels;  // indices of the other levels whose bounds overlap the bounds of a level
  // Positions of boxes of two levels: of those that overlap the bounds of the other level.
  std::vector<std::uint32_t> positions, other_positions;
  std::vector<float> bounds;
  std::vector<std::uint32_t> ids;
};

/// Finds the pairs of boxes of which at least one is in a given region of a layer.
class RegionSearch {
 public:
  RegionSearch(const kernels::Kernels& kernels, GatheredBoxes& gathered, kernels::PairSink* sink)
      : kernels_(kernels), gathered_(gathered), sink_(sink) {}

  /// Finds the pairs of a region's boxes with each other and with the boxes of later regions.
  void within(const Layer& layer, std::uint32_t number);
  /// Finds the pairs of a region's boxes with the boxes of another layer.
  void across(const Layer& layer, std::uint32_t number, const Layer& other);

 private:
  void meetAll(const Layer& layer, const kernels::Region& region, const Layer& other, std::uint32_t least);
  void meet(const kernels::Level& a, const kernels::Level& b);
  void select(const kernels::Level& asking, const kernels::Level& asked, PositionWriter& near) const;
  void askSome(const kernels::Level& asking, const PositionWriter& positions, const kernels::Level& asked);

  const kernels::Kernels& kernels_;
  GatheredBoxes& gathered_;
  kernels::PairSink* sink_;
};

}  // namespace hgrid
