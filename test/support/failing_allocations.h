// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A program that links failing_allocations.cpp gets an operator new that fails when a test requests it.
#pragma once

#include <cstddef>
#include <new>
#include <ostream>

namespace hgrid {
namespace test {

/// Selects the allocations that fail. k is counted from 1.
enum class Failing {
  one,           ///< only the k-th allocation
  from_then_on,  ///< the k-th allocation and all later ones
};

inline std::ostream& operator<<(std::ostream& out, Failing which) {
  return out << (which == Failing::one ? "one" : "from then on");
}

/// While this object exists, operator new throws std::bad_alloc for the selected calls on this thread. The object also
/// counts all calls on this thread.
class FailingAllocations {
 public:
  /// @param k  the k-th call of operator new is the first that fails, counted from 1; 0 means that none fails
  explicit FailingAllocations(std::size_t k, Failing which = Failing::one);
  ~FailingAllocations();
  FailingAllocations(const FailingAllocations&) = delete;
  FailingAllocations& operator=(const FailingAllocations&) = delete;

  /// Returns the number of calls of operator new on this thread since this object was created.
  std::size_t calls() const;
};

/// Runs `act`. @returns the number of allocations that `act` made on this thread
template <class Act>
std::size_t allocationsOf(Act&& act) {
  const FailingAllocations none(0);
  act();
  return none.calls();
}

/// Runs `act` and lets its k-th allocation fail. @returns whether `act` threw std::bad_alloc
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
