// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Where kernels write what they find.
// Part of kernels_body.h, which says what Simd is.
#pragma once

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

constexpr int kBlock = 16;  // boxes that look around together; the same for every instruction set

/// A sink while a kernel writes to it: kept out of memory, since for all that a compiler knows what is written could
/// change where to write next.
template <class Found>
class Output {
 public:
  explicit Output(Sink<Found>* sink) : sink_(sink), next_(sink->next), limit_(sink->limit) {}
  Found* room() {
    if (__builtin_expect(limit_ - next_ < kBlock, 0)) grow();
    return next_;
  }
  void wrote(Found* end) { next_ = end; }
  bool full() const { return full_; }
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
