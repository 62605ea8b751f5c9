// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// A margin for the pairs that match two globs over body names, in either order.
struct PairMargin {
  std::string first, second;
  double margin = 0.0;  ///< [m] >= 0
};

/// Margins of their own that pairs of bodies have. Globs are matched once per body. Immutable.
class PairMargins {
 public:
  PairMargins() = default;
  /// @param bodies  what the indices below mean; not kept
  PairMargins(const std::vector<Body>& bodies, const std::vector<PairMargin>& margins);

  /// [m] Of a pair: that of the last entry that matches; nothing if none does.
  std::optional<double> of(std::uint32_t first, std::uint32_t second) const {
    if (words_ == 0) return std::nullopt;
    return look(first, second);
  }
  /// [m] The largest that a pair with this body may have; 0 if it has none.
  double largestOf(std::uint32_t body) const { return words_ == 0 ? 0.0 : largest_[body]; }

 private:
  std::optional<double> look(std::uint32_t first, std::uint32_t second) const;

  std::vector<double> margins_;
  std::vector<double> largest_;                      // by body
  std::size_t words_ = 0;                            // 64-bit words per body in the bit sets
  std::vector<std::uint64_t> as_first_, as_second_;  // bit k: the body matches entry k's first, second
};

}  // namespace hgrid
