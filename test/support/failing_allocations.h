// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A program that links failing_allocations.cpp has an operator new that can be told to fail.
#pragma once

#include <cstddef>
#include <new>
#include <ostream>

namespace hgrid {
namespace test {

/// Which allocations fail.
enum class Failing {
  one,           ///< the k-th one
  from_then_on,  ///< the k-th one and all that follow
};

inline std::ostream& operator<<(std::ostream& out, Failing which) {
  return out << (which == Failing::one ? "one" : "from then on");
}

/// While it lives, operator new throws std::bad_alloc on this thread as it was told. It counts the calls either way.
class FailingAllocations {
 public:
  /// @param k  number of the first call of operator new that fails, from 1; 0: none fails
  explicit FailingAllocations(std::size_t k, Failing which = Failing::one);
  ~FailingAllocations();
  FailingAllocations(const FailingAllocations&) = delete;
  FailingAllocations& operator=(const FailingAllocations&) = delete;

  /// Calls of operator new since it was made, on this thread.
  std::size_t calls() const;
};

/// Allocations of `act` on this thread.
template <class Act>
std::size_t allocationsOf(Act&& act) {
  const FailingAllocations none(0);
  act();
  return none.calls();
}

/// Lets the k-th allocation of `act` fail. @returns whether `act` has thrown std::bad_alloc
template <class Act>
bool failsAt(std::size_t k, Failing which, Act&& act) {
  try {
    const FailingAllocations failing(k, which);
    act();
  } catch (const std::bad_alloc&) {
    return true;
  }
  return false;
}

}  // namespace test
}  // namespace hgrid
