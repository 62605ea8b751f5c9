// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/failing_allocations.h"

#include <cstdlib>

namespace hgrid {
namespace test {
namespace {

struct Order {
  bool given = false;
  Failing which = Failing::one;
  std::size_t first = 0;  // the call with this number, counted from 1, is the first that fails; 0: none fails
  std::size_t calls = 0;
};
thread_local Order order;

bool failsNow() {
  if (!order.given) return false;
  ++order.calls;
  if (order.first == 0) return false;
  return order.which == Failing::one ? order.calls == order.first : order.calls >= order.first;
}

void* allocated(std::size_t size, std::size_t alignment) {
  if (failsNow()) throw std::bad_alloc();
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* memory = alignment <= alignof(std::max_align_t) ? std::malloc(size == 0 ? 1 : size)
                                                        : std::aligned_alloc(alignment, rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

FailingAllocations::FailingAllocations(std::size_t k, Failing which) { order = {true, which, k, 0}; }
FailingAllocations::~FailingAllocations() { order = Order{}; }
std::size_t FailingAllocations::calls() const { return order.calls; }

}  // namespace test
}  // namespace hgrid

// Not inlined, because the compiler would otherwise warn that free() receives memory that is not from malloc().
__attribute__((noinline)) void* operator new(std::size_t size) { return hgrid::test::allocated(size, 1); }
__attribute__((noinline)) void* operator new[](std::size_t size) { return hgrid::test::allocated(size, 1); }
__attribute__((noinline)) void* operator new(std::size_t size, std::align_val_t alignment) {
  return hgrid::test::allocated(size, static_cast<std::size_t>(alignment));
}
__attribute__((noinline)) void* operator new[](std::size_t size, std::align_val_t alignment) {
  return hgrid::test::allocated(size, static_cast<std::size_t>(alignment));
}
// As in the standard library. A sanitizer has a function of its own, whose memory must not be passed to free().
__attribute__((noinline)) void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
__attribute__((noinline)) void operator delete(void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
__attribute__((noinline)) void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
__attribute__((noinline)) void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}
