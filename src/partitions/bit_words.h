// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {
namespace book {

/// Four words, which the compiler processes with vector instructions.
using FourWords = std::uint64_t __attribute__((vector_size(32), aligned(8), may_alias));

inline const FourWords& four(const std::uint64_t* words) { return *reinterpret_cast<const FourWords*>(words); }
inline FourWords& four(std::uint64_t* words) { return *reinterpret_cast<FourWords*>(words); }

/// Calls visit(id) for each bit that is set, in ascending order. The first word has the bits of the ids from
/// 64 * `first_word` on. The number of trailing zeros is the index of the lowest bit that is set; then
/// bits & (bits - 1) clears this bit. BitGrid says what the book does instead.
template <class Visit>
void visitBits(const std::uint64_t* words, std::size_t count, std::size_t first_word, Visit&& visit) {
  for (std::size_t word = 0; word < count; ++word) {
    for (std::uint64_t bits = words[word]; bits != 0; bits &= bits - 1)
      visit(static_cast<ProxyId>((first_word + word) * 64 + static_cast<std::size_t>(__builtin_ctzll(bits))));
  }
}

}  // namespace book
}  // namespace hgrid
