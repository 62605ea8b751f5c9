// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body_list.h"

namespace hgrid {

/// The margin of all pairs whose body names match these two globs, in either order.
struct PairMargin {
  std::string first;    ///< glob over the name of one body
  std::string second;   ///< glob over the name of the other body
  double margin = 0.0;  ///< [m] >= 0
};

/// The margins that are configured for single pairs of bodies. Matches globs once per body. Immutable.
class PairMargins {
 public:
  PairMargins() = default;
  /// @param bodies  the bodies that the indices in the other functions refer to; not kept
  PairMargins(const BodyList& bodies, const std::vector<PairMargin>& margins);

  /// Returns the margin [m] of the last entry that matches a pair; nullopt if no entry matches the pair.
  std::optional<double> of(std::uint32_t first, std::uint32_t second) const {
    if (words_ == 0) return std::nullopt;
    return look(first, second);
  }
  /// Returns the largest margin [m] of all entries with a glob that matches this body; 0 if there is no such entry.
  double largestOf(std::uint32_t body) const { return words_ == 0 ? 0.0 : largest_[body]; }
  /// Returns the memory [bytes] that the margins use.
  std::size_t bytes() const {
    return sizeof(*this) +
           8 * (margins_.capacity() + largest_.capacity() + as_first_.capacity() + as_second_.capacity());
  }

 private:
  std::optional<double> look(std::uint32_t first, std::uint32_t second) const;

  std::vector<double> margins_;
  std::vector<double> largest_;           // [m] for each body: largest margin of its entries
  std::size_t words_ = 0;                 // number of 64-bit words per body in the bit sets
  std::vector<std::uint64_t> as_first_;   // bit sets, one per body: bit k: it matches `first` of entry k
  std::vector<std::uint64_t> as_second_;  // bit sets, one per body: bit k: it matches `second` of entry k
};

}  // namespace hgrid
