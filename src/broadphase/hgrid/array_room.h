// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <vector>

namespace hgrid {

/// Returns the size to allocate. The first allocation is exact. Later allocations are larger than requested, so that a
/// grid with a steady number of boxes soon allocates nothing.
inline std::size_t roomFor(std::size_t size, bool first) { return first ? size : size + size / 16; }

/// Enlarges an array if it is too small. An enlarged array has lost its values, so the caller writes all of them again.
template <class Value>
void growTo(std::vector<Value>& values, std::size_t size) {
  if (values.size() < size) std::vector<Value>(roomFor(size, values.empty())).swap(values);
}

/// Enlarges an array if it is too small, and keeps its values. @returns whether the array has a new address
template <class Value>
bool extendTo(std::vector<Value>& values, std::size_t size) {
  if (values.size() >= size) return false;
  const std::size_t room = roomFor(size, values.empty());
  values.reserve(room);  // resize() alone would double the array
  values.resize(room);
  return true;
}

}  // namespace hgrid
