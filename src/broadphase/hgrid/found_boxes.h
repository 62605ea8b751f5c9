// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "broadphase/hgrid/layer.h"
#include "broadphase/hgrid/query_tree.h"

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

inline kernels::Box boxOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

inline bool overlap(const kernels::Box& a, const kernels::Box& b) {
  bool both = true;
  for (int axis = 0; axis < 3; ++axis) both = both & (a.min[axis] <= b.max[axis]) & (b.min[axis] <= a.max[axis]);
  return both;
}

/// Searches each layer: its tree if there is one, else its levels. Calls visit(boxes, places) for each layer in which a
/// search finds boxes. `boxes` is a Layer and the places are positions, or it is a QueryTree and they are slots. Both
/// have the functions boxAt(place) and idAt(place). Inlined, because a call takes a part of the time of a query into
/// empty space.
/// @param search_tree  called as bool search_tree(const kernels::BoxTree&, kernels::PositionSink*); writes slots.
///                     Returns false if the levels must be searched instead
/// @param search_layer  called as void search_layer(const Layer&, kernels::PositionSink*); searches the levels and
///                      writes positions
template <class Engine, class SearchTree, class SearchLayer, class Visit>
inline __attribute__((always_inline)) void visitFound(const Engine& engine, SearchTree&& search_tree,
                                                      SearchLayer&& search_layer, Visit&& visit) {
  for (std::size_t number = 0; number < engine.layers.size(); ++number) {
    const Layer& layer = engine.layers[number];
    if (layer.size() == 0) continue;
    PositionWriter writer;
    const QueryTree* const tree = engine.treeOf(number);
    if (tree != nullptr && search_tree(tree->view(), writer.sink())) {
      if (writer.size() != 0) visit(*tree, writer);
    } else {
      search_layer(layer, writer.sink());
      if (writer.size() != 0) visit(layer, writer);
    }
  }
}

/// Calls visit(boxes, places) for each layer in which boxes overlap `box`, see visitFound().
template <class Engine, class Visit>
void visitOverlapping(const Engine& engine, const kernels::Box& box, Visit&& visit) {
  visitFound(
      engine,
      [&](const kernels::BoxTree& tree, kernels::PositionSink* sink) {
        engine.loops->overlappingInTree(&tree, &box, sink);
        return true;
      },
      [&](const Layer& layer, kernels::PositionSink* sink) {
        const kernels::LevelSet levels = layer.querySet();
        if (layer.occupancy().mayOverlap(box)) engine.loops->overlapping(&levels, &box, sink);
      },
      visit);
}

}  // namespace hgrid
