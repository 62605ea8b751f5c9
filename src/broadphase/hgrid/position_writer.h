// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"

namespace hgrid {

/// Lets kernels write places of boxes. The first places are stored in this object, all of them in a vector if there are
/// more. On one thread, only one writer without a vector of its own may be in use at a time.
class PositionWriter {
 public:
  /// Uses a vector that the thread keeps, so only the first few queries allocate.
  PositionWriter() : PositionWriter(nullptr) {}
  /// Uses this vector. @param buffer  must outlive the object
  explicit PositionWriter(std::vector<std::uint32_t>& buffer) : PositionWriter(&buffer) {}
  PositionWriter(const PositionWriter&) = delete;
  PositionWriter& operator=(const PositionWriter&) = delete;

  kernels::PositionSink* sink() { return &sink_; }
  const std::uint32_t* begin() const { return first_; }
  const std::uint32_t* end() const { return sink_.next; }
  std::size_t size() const { return static_cast<std::size_t>(end() - begin()); }

 private:
  static constexpr std::size_t kFew = 128;

  // Does not initialize few_, because that would take as long as some queries.
  explicit PositionWriter(std::vector<std::uint32_t>* buffer)  // NOLINT(*-member-init)
      : buffer_(buffer), first_(few_), sink_{few_, few_ + kFew, this, grow, false} {}

  static void grow(kernels::PositionSink* sink) {
    thread_local std::vector<std::uint32_t> of_thread;
    auto& self = *static_cast<PositionWriter*>(sink->owner);
    std::vector<std::uint32_t>& buffer = self.buffer_ == nullptr ? of_thread : *self.buffer_;
    const std::size_t used = self.size();
    if (buffer.size() < 2 * used) buffer.resize(std::max<std::size_t>(2 * used, 1024));
    if (self.first_ == self.few_) std::copy(self.few_, self.few_ + used, buffer.data());
    self.first_ = buffer.data();
    sink->next = buffer.data() + used;
    sink->limit = buffer.data() + buffer.size();
  }

  std::vector<std::uint32_t>* buffer_;
  std::uint32_t* first_;
  kernels::PositionSink sink_;
  std::uint32_t few_[kFew];
};

}  // namespace hgrid
