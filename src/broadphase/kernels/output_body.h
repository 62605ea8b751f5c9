// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Lets kernels write their results to a sink.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include <cstdint>

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

constexpr int kBlock = 16;  // boxes that a kernel processes together; the same number for every instruction set

/// A local copy of a sink. A kernel writes its results through this copy, because the compiler can keep the pointers of
/// the copy in registers. With the sink itself, it would have to assume that writing a result changes the pointers.
template <class Found>
class Output {
 public:
  explicit Output(Sink<Found>* sink) : sink_(sink), next_(sink->next), limit_(sink->limit) {}
  /// Returns where to write the next results. There is room for at least kBlock results.
  Found* room() {
    if (__builtin_expect(limit_ - next_ < kBlock, 0)) grow();
    return next_;
  }
  /// Records that results were written up to `end`.
  void wrote(Found* end) { next_ = end; }
  /// Returns the address of the end of the results, as a number.
  std::uintptr_t address() const { return reinterpret_cast<std::uintptr_t>(next_); }
  bool full() const { return full_; }
  /// Copies the end of the results back to the sink.
  void close() { sink_->next = next_; }

 private:
  void __attribute__((noinline)) grow() {
    sink_->next = next_;
    sink_->grow(sink_);
    next_ = sink_->next;
    limit_ = sink_->limit;
    full_ = sink_->full;
  }
  Sink<Found>* sink_;
  Found *next_, *limit_;
  bool full_ = false;
};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
