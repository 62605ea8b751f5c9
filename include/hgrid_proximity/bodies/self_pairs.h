// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>

namespace hgrid {

class LinkMatrix;
struct RobotModel;

/// Counts the pairs of links within one robot. For each Origin, it also counts the pairs that this origin switched off.
/// Only links with geometry count.
struct SelfPairs {
  std::size_t links = 0;     ///< links with geometry
  std::size_t pairs = 0;     ///< all pairs of these links
  std::size_t rigid = 0;     ///< pairs that are switched off because of Origin::rigid
  std::size_t adjacent = 0;  ///< pairs that are switched off because of Origin::adjacent
  std::size_t srdf = 0;      ///< pairs that are switched off because of Origin::srdf

  /// Returns the number of pairs that are switched off.
  std::size_t off() const { return rigid + adjacent + srdf; }
  /// Whether there are pairs, and all of them are switched off.
  bool allOff() const { return pairs > 0 && off() == pairs; }
  /// Whether the counts deserve a warning: all pairs are switched off. A robot of two links is an exception if the URDF
  /// switches off their only pair, because that is normal for a slide or a turntable.
  bool looksWrong() const { return allOff() && (links > 2 || srdf > 0); }
};

/// Counts the pairs of the links of `model`. `matrix` must belong to the same model.
SelfPairs countSelfPairs(const RobotModel& model, const LinkMatrix& matrix);

/// Returns the counts as a clause: "7 of the 36 pairs of its 9 links with geometry are off (0 rigid, 7 adjacent, 0 by
/// SRDF)".
std::string text(const SelfPairs& counts);

}  // namespace hgrid
