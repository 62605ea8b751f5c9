// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Returns whether pair `a` comes before pair `b` in the order by (first, second).
template <class A, class B>
bool before(const A& a, const B& b) {
  return a.first != b.first ? a.first < b.first : a.second < b.second;
}

}  // namespace hgrid
