// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "broadphase/engine.h"

namespace hgrid {
namespace {

/// Lets kernels write positions into a vector that belongs to the thread: a query allocates nothing once it is warm.
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
  void clear() { sink_.next = buffer_.data(); }

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

std::vector<std::uint32_t>& bufferOfThread() {
  thread_local std::vector<std::uint32_t> buffer;
  return buffer;
}

/// Lists of a few hits are the rule; std::sort has a price of its own.
template <class Iterator, class Less>
void sortFew(Iterator begin, Iterator end, Less less) {
  if (end - begin > 24) return std::sort(begin, end, less);
  for (Iterator i = begin; i != end; ++i) {
    auto value = *i;
    Iterator j = i;
    for (; j != begin && less(value, *(j - 1)); --j) *j = *(j - 1);
    *j = value;
  }
}

kernels::Box boxAround(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
  kernels::Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<float>(min[axis]), high = static_cast<float>(max[axis]);
    box.min[axis] = low - std::abs(low) * 1.2e-7f - 1e-37f;  // outward, and faster than exactly so
    box.max[axis] = high + std::abs(high) * 1.2e-7f + 1e-37f;
  }
  return box;
}

kernels::Box boxOf(const Aabb& box) {
  return {{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}};
}

kernels::Box boxOf(const Sphere& sphere) {
  const double reach = sphere.center.cwiseAbs().maxCoeff() + sphere.radius;
  const Eigen::Array3d half = Eigen::Array3d::Constant(sphere.radius + 2.0 * roundingSlack(reach));
  return boxAround(sphere.center.array() - half, sphere.center.array() + half);
}

kernels::Box boxOf(const Segment& segment) {
  const double reach =
      std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff()) + segment.radius;
  const Eigen::Vector3d around = Eigen::Vector3d::Constant(segment.radius + 4.0 * roundingSlack(reach));
  return boxAround(segment.from.cwiseMin(segment.to) - around, segment.from.cwiseMax(segment.to) + around);
}

bool earlier(const SegmentHit& a, const SegmentHit& b) { return a.along != b.along ? a.along < b.along : a.id < b.id; }

/// The segment as kernels take it.
kernels::Line lineOf(const Segment& segment) {
  kernels::Line line;
  const double reach =
      std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff()) + segment.radius;
  line.around = segment.radius + 4.0 * roundingSlack(reach);
  for (int axis = 0; axis < 3; ++axis) {
    line.from[axis] = segment.from[axis];
    line.way[axis] = segment.to[axis] - segment.from[axis];
  }
  return line;
}

/// Calls `visit` with the layer and position of each box that `search` finds on a level.
template <class Engine, class Search, class Visit>
void visitFound(const Engine& engine, Search&& search, Visit&& visit) {
  PositionWriter writer(bufferOfThread());
  for (const Layer& layer : engine.layers) {
    if (layer.size() == 0) continue;
    for (const kernels::Level& level : layer.levels()) search(level, writer.sink());
    for (const std::uint32_t position : writer) visit(layer, position);
    writer.clear();
  }
}

// Answers to one question, appended. Several threads may ask at once.
template <class Engine>
void answer(const Engine& engine, const Aabb& query, std::vector<ProxyId>& found) {
  const kernels::Kernels& kernels = kernels::of(engine.isa);
  const kernels::Box box = boxOf(query);
  const std::size_t before = found.size();
  visitFound(
      engine,
      [&](const kernels::Level& level, kernels::PositionSink* sink) { kernels.overlapping(&level, &box, sink); },
      [&](const Layer& layer, std::uint32_t position) { found.push_back(layer.ids()[position]); });
  sortFew(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(), std::less<ProxyId>());
}

template <class Engine>
void answer(const Engine& engine, const Sphere& query, std::vector<ProxyId>& found) {
  const double near = touchingDistance(query);
  const kernels::Kernels& kernels = kernels::of(engine.isa);
  const kernels::Box box = boxOf(query);
  const std::size_t before = found.size();
  visitFound(
      engine,
      [&](const kernels::Level& level, kernels::PositionSink* sink) { kernels.overlapping(&level, &box, sink); },
      [&](const Layer& layer, std::uint32_t position) {
        if (distance(layer.boxAt(position), query.center) <= near) found.push_back(layer.ids()[position]);
      });
  sortFew(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(), std::less<ProxyId>());
}

template <class Engine>
void answer(const Engine& engine, const Segment& query, std::vector<SegmentHit>& found) {
  const kernels::Kernels& kernels = kernels::of(engine.isa);
  const kernels::Line line = lineOf(query);
  const std::size_t before = found.size();
  visitFound(
      engine, [&](const kernels::Level& level, kernels::PositionSink* sink) { kernels.along(&level, &line, sink); },
      [&](const Layer& layer, std::uint32_t position) {
        if (const auto along = firstTouch(query, layer.boxAt(position))) {
          found.push_back({layer.ids()[position], *along});
        }
      });
  sortFew(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(), earlier);
}

/// Answers questions by their places, so that those that look at the same boxes follow each other: in buckets of a
/// coarse grid over the largest layer.
template <class Engine, class Query, class Found>
void answerAll(const Engine& engine, const std::vector<Query>& queries, BatchOf<Found>& batch) {
  constexpr float kAcross = 16.0f;
  batch.begin.assign(queries.size(), 0);
  batch.count.assign(queries.size(), 0);
  batch.found.clear();
  const Layer* largest = &engine.layers[0];
  for (const Layer& layer : engine.layers) {
    if (layer.size() > largest->size()) largest = &layer;
  }
  if (largest->size() == 0) return;
  const kernels::Grid& grid = largest->levels().front().grid;
  std::vector<std::uint32_t> next(static_cast<std::size_t>(kAcross * kAcross * kAcross) + 1, 0);
  std::vector<std::uint32_t> buckets(queries.size()), order(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const kernels::Box box = boxOf(queries[i]);
    float bucket = 0.0f;
    for (const int axis : {2, 1, 0}) {
      const float cell = box.min[axis] * grid.inverse[axis] - grid.origin[axis];
      const float share = cell / (grid.last[axis] + 1.0f);
      bucket = bucket * kAcross + std::floor(kAcross * std::min(share > 0.0f ? share : 0.0f, 0.999f));
    }
    buckets[i] = static_cast<std::uint32_t>(bucket);
    ++next[buckets[i] + 1];
  }
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  for (std::uint32_t i = 0; i < queries.size(); ++i) order[next[buckets[i]]++] = i;
  for (const std::uint32_t i : order) {
    batch.begin[i] = static_cast<std::uint32_t>(batch.found.size());
    answer(engine, queries[i], batch.found);
    batch.count[i] = static_cast<std::uint32_t>(batch.found.size()) - batch.begin[i];
  }
}

}  // namespace

void HGrid::overlapping(const Aabb& box, std::vector<ProxyId>& found) const {
  found.clear();
  answer(*engine_, box, found);
}

void HGrid::overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const {
  found.clear();
  answer(*engine_, sphere, found);
}

void HGrid::along(const Segment& segment, std::vector<SegmentHit>& found) const {
  found.clear();
  answer(*engine_, segment, found);
}

void HGrid::overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const { answerAll(*engine_, boxes, found); }

void HGrid::overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const {
  answerAll(*engine_, spheres, found);
}

void HGrid::along(const std::vector<Segment>& segments, SegmentBatch& found) const {
  answerAll(*engine_, segments, found);
}

void HGrid::nearest(const Eigen::Vector3d& point, std::size_t count, double limit, std::vector<NearHit>& found) const {
  found.clear();
  const Engine& e = *engine_;
  count = std::min(count, e.stored);
  if (count == 0 || !(limit >= 0.0)) return;
  // Balls that grow until one holds enough boxes; what a ball finds is all that is as near as its radius.
  double radius = std::numeric_limits<double>::infinity();
  for (const Layer& layer : e.layers) {
    for (const kernels::Level& level : layer.levels()) {
      if (level.begin < level.end) radius = std::min(radius, 0.5 / static_cast<double>(level.grid.inverse[1]));
    }
  }
  std::vector<ProxyId> ids;
  for (;; radius *= 2.0) {
    radius = std::min(radius, limit);
    const bool all = !(radius < 1e30);
    if (all) {
      ids.clear();
      for (ProxyId id = 0; id < e.place.size(); ++id) {
        if (e.isStored(id)) ids.push_back(id);
      }
    } else {
      overlapping(Sphere{point, radius}, ids);
    }
    found.clear();
    for (const ProxyId id : ids) {
      const double away = distance(e.boxes[id], point);
      if (away <= radius) found.push_back({id, away});
    }
    if (found.size() >= count || all || radius >= limit) break;
  }
  const auto nearer = [](const NearHit& a, const NearHit& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.id < b.id;
  };
  count = std::min(count, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end(), nearer);
  found.resize(count);
}

}  // namespace hgrid
