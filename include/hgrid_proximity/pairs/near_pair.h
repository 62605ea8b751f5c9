// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Why a pair is selected although it is beyond its margin, and what is unusual about it. Bits.
enum PairFlags : std::uint8_t {
  kHorizonFlag = 1,   ///< the two can meet within the horizon, or passed each other since the last tick
  kTeleportFlag = 2,  ///< one of them moved farther since the last tick than its max_speed allows
};

/// A candidate pair: two bodies whose boxes are within their margin, or may soon be.
struct NearPair {
  std::uint32_t first = 0;  ///< index into Structure::bodies, first < second
  std::uint32_t second = 0;
  double gap = 0.0;        ///< [m] least distance of their boxes
  double margin = 0.0;     ///< [m] margin that selected the pair, growth of stale bodies included
  Time since{0};           ///< stamp of the tick in which it was first seen without interruption
  std::uint8_t flags = 0;  ///< of PairFlags
};

}  // namespace hgrid
