// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "broadphase/hgrid/layer.h"

namespace hgrid {

/// Lets kernels write positions of boxes (see Layer) into a vector. Enlarges the vector when it is full.
class PositionWriter {
 public:
  explicit PositionWriter(std::vector<std::uint32_t>& buffer) : buffer_(buffer) {
    if (buffer_.empty()) buffer_.resize(1024);
    sink_.owner = this;
    sink_.grow = grow;
    restart(0);
  }
  kernels::PositionSink* sink() { return &sink_; }
  const std::uint32_t* begin() const { return buffer_.data(); }
  const std::uint32_t* end() const { return sink_.next; }
  std::size_t size() const { return static_cast<std::size_t>(end() - begin()); }

 private:
  void restart(std::size_t used) {
    sink_.next = buffer_.data() + used;
    sink_.limit = buffer_.data() + buffer_.size();
  }
  static void grow(kernels::PositionSink* sink) {
    auto* self = static_cast<PositionWriter*>(sink->owner);
    const auto used = static_cast<std::size_t>(sink->next - self->buffer_.data());
    self->buffer_.resize(2 * self->buffer_.size());
    self->restart(used);
  }

  std::vector<std::uint32_t>& buffer_;
  kernels::PositionSink sink_{};
};

/// Returns this thread's buffer for positions. The buffer keeps its memory, so only the first few queries allocate.
inline std::vector<std::uint32_t>& bufferOfThread() {
  thread_local std::vector<std::uint32_t> buffer;
  return buffer;
}

inline kernels::Box boxOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

inline bool overlap(const kernels::Box& a, const kernels::Box& b) {
  bool both = true;
  for (int axis = 0; axis < 3; ++axis) both = both & (a.min[axis] <= b.max[axis]) & (b.min[axis] <= a.max[axis]);
  return both;
}

/// Searches each layer. Calls visit(layer, positions) for each layer in which `search` finds boxes.
/// @param may_have  called as bool may_have(const Occupancy&); says whether a layer needs a search
/// @param search  called as void search(const kernels::LevelSet&, kernels::PositionSink*); writes the positions of the
///                boxes that it finds
template <class Engine, class MayHave, class Search, class Visit>
void visitFound(const Engine& engine, MayHave&& may_have, Search&& search, Visit&& visit) {
  for (const Layer& layer : engine.layers) {
    if (layer.size() == 0 || !may_have(layer.occupancy())) continue;
    PositionWriter writer(bufferOfThread());
    search(layer.querySet(), writer.sink());
    if (writer.size() == 0) continue;
    visit(layer, writer);
  }
}

/// Calls visit(layer, positions) for each layer in which boxes overlap a box.
/// @param make_box  returns the box; called only for layers that need a search
/// @param may_have  says whether a layer needs a search, see visitFound()
template <class Engine, class MakeBox, class MayHave, class Visit>
void visitOverlapping(const Engine& engine, MakeBox&& make_box, MayHave&& may_have, Visit&& visit) {
  visitFound(
      engine, may_have,
      [&](const kernels::LevelSet& levels, kernels::PositionSink* sink) {
        const kernels::Box box = make_box();
        kernels::of(engine.isa).overlapping(&levels, &box, sink);
      },
      visit);
}

/// Calls visit(layer, positions) for each layer in which boxes overlap `box`.
template <class Engine, class Visit>
void visitOverlapping(const Engine& engine, const kernels::Box& box, Visit&& visit) {
  visitOverlapping(
      engine, [&] { return box; }, [&](const Occupancy& occupancy) { return occupancy.mayOverlap(box); }, visit);
}

}  // namespace hgrid
