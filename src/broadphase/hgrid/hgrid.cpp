// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/hgrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "broadphase/hgrid/engine.h"

namespace hgrid {
namespace {

void requireValid(const Aabb& box) {
  if (!isValid(box))
    throw std::invalid_argument("HGrid: a box has min > max or a coordinate that is not finite; correct it");
}

constexpr std::size_t kPerJob = 4096;  // boxes that one job checks or copies

/// Divides 0 .. count - 1 into parts and calls job(begin, end) for each part. The workers share the parts.
template <class Job>
void inParts(Workers& workers, std::size_t count, Job&& job) {
  if (count <= kPerJob) return job(std::size_t{0}, count);
  workers.run((count + kPerJob - 1) / kPerJob,
              [&](std::size_t part, std::size_t) { job(part * kPerJob, std::min((part + 1) * kPerJob, count)); });
}

/// Returns whether ascending ids are exactly 0 .. count - 1. For ascending ids, it is enough to check the last one.
bool areAll(const std::vector<ProxyId>& ids) { return !ids.empty() && ids.back() + std::size_t{1} == ids.size(); }

/// Estimates from a sample of the updated boxes whether more than half of them moved. Then all boxes should be sorted.
bool mostMoved(const std::vector<Aabb>& stored, const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  const std::size_t stride = std::max<std::size_t>(1, ids.size() / 256);
  std::size_t seen = 0, moved = 0;
  for (std::size_t i = 0; i < ids.size(); i += stride, ++seen) moved += stored[ids[i]] != boxes[i];
  return 2 * moved > seen;
}

}  // namespace

GridScale GridScale::fitting(const std::vector<Aabb>& boxes) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Aabb& box : boxes) {
    const double side = (box.max.cast<double>() - box.min.cast<double>()).maxCoeff();
    if (side > 0.0) smallest = std::min(smallest, side);
  }
  GridScale scale;
  scale.finest_edge = std::isfinite(smallest) ? std::clamp(2.0 * smallest, 0x1p-20, 0x1p10) : 1.0;
  return scale;
}

void HGrid::Engine::requireValid(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given) {
  if (ids.size() != given.size()) {
    throw std::invalid_argument("HGrid: " + std::to_string(ids.size()) + " ids but " + std::to_string(given.size()) +
                                " boxes were given; each box needs one id");
  }
  std::atomic<bool> all_ascend{true}, all_sound{true};
  inParts(*workers, ids.size(), [&](std::size_t begin, std::size_t end) {
    bool ascend = true;
    for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) ascend = ascend & (ids[i - 1] < ids[i]);
    if (!ascend) all_ascend = false;
    const auto* first = reinterpret_cast<const kernels::Box*>(given.data()) + begin;
    if (!loops->sound(first, end - begin)) all_sound = false;
  });
  if (!all_ascend) throw std::invalid_argument("HGrid: the ids do not ascend; sort them, and use each id once");
  if (!all_sound)
    throw std::invalid_argument("HGrid: a box has min > max or a coordinate that is not finite; correct it");
}

HGrid::HGrid(const GridScale& scale) {
  if (!(scale.finest_edge >= 0x1p-30 && scale.finest_edge <= 0x1p30)) {
    throw std::invalid_argument("HGrid: the finest edge is " + std::to_string(scale.finest_edge) +
                                " m; it must be within 2^-30 .. 2^30");
  }
  engine_ = std::make_unique<Engine>(std::ldexp(1.0, std::ilogb(scale.finest_edge)));
}

HGrid::~HGrid() = default;
HGrid::HGrid(HGrid&&) noexcept = default;
HGrid& HGrid::operator=(HGrid&&) noexcept = default;

void HGrid::setIsa(Isa isa) {
  if (!isSupported(isa)) {
    throw std::invalid_argument(std::string("HGrid: this processor or build does not support ") + hgrid::name(isa) +
                                "; choose another instruction set");
  }
  engine_->isa = isa;
  engine_->loops = &kernels::of(isa);
}

Isa HGrid::isa() const { return engine_->isa; }

void HGrid::setThreads(int threads) {
  if (threads < 1 || threads > 64) {
    throw std::invalid_argument("HGrid: threads is " + std::to_string(threads) + "; it must be within 1 .. 64");
  }
  if (threads != engine_->workers->threads()) engine_->workers = std::make_unique<Workers>(threads);
}

int HGrid::threads() const { return engine_->workers->threads(); }

void HGrid::setFixed(const std::vector<ProxyId>& ids) {
  if (!std::is_sorted(ids.begin(), ids.end())) throw std::invalid_argument("HGrid: the ids do not ascend; sort them");
  std::vector<bool> fixed(ids.empty() ? 0 : ids.back() + std::size_t{1});
  for (const ProxyId id : ids) fixed[id] = true;
  if (fixed == engine_->fixed) return;
  engine_->fixed.swap(fixed);
  try {
    engine_->sortAll(true);
  } catch (...) {
    engine_->fixed.swap(fixed);
    throw;
  }
}

void HGrid::setOverlapFilter(const OverlapFilter& filter) {
  engine_->filter = filter;
  engine_->dropKept();
}

void HGrid::insert(ProxyId id, const Aabb& box) {
  requireValid(box);
  Engine& e = *engine_;
  if (e.isStored(id))
    throw std::invalid_argument("HGrid: box " + std::to_string(id) + " is already stored; change it with update()");
  e.grow(id);
  e.reserveLoose(id, box);
  e.boxes[id] = box;
  e.putLoose(id);
}

void HGrid::update(ProxyId id, const Aabb& box) {
  requireValid(box);
  Engine& e = *engine_;
  e.requireStored(id);
  if (e.boxes[id] == box) return;  // exact comparison: a tolerance would ignore small moves
  if (e.moveSingle(id, box)) return;
  e.reserveLoose(id, box);
  e.takeOut(id);
  e.boxes[id] = box;
  e.putLoose(id);
}

void HGrid::remove(ProxyId id) {
  engine_->requireStored(id);
  engine_->takeOut(id);
}

void HGrid::clear() {
  Engine& e = *engine_;
  std::fill(e.layer_of.begin(), e.layer_of.end(), Engine::kAbsent);
  e.stored = 0;
  e.sortAll(true);
}

void HGrid::update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  Engine& e = *engine_;
  e.requireValid(ids, boxes);
  if (!ids.empty()) e.grow(ids.back());
  e.unhash();
  try {
    e.replace(ids, boxes);
  } catch (...) {
    e.restoreFromLayers();
    throw;
  }
}

/// Performs the bulk update. Changes `boxes` and `layer_of` before it sorts. If this function throws, the caller must
/// restore both.
void HGrid::Engine::replace(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given) {
  bool same = stored == ids.size();
  if (same && !(areAll(ids) && layer_of.size() == ids.size())) {
    for (std::size_t i = 0; same && i < ids.size(); ++i) same = layer_of[ids[i]] != kAbsent;
  }
  if (!same) {
    std::fill(layer_of.begin(), layer_of.end(), kAbsent);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      layer_of[ids[i]] = kResting;
      boxes[ids[i]] = given[i];
    }
    stored = ids.size();
    return sortAll(true);
  }
  if (mostMoved(boxes, ids, given)) {
    inParts(*workers, ids.size(), [&](std::size_t begin, std::size_t end) {
      if (areAll(ids)) {
        std::copy(&given[begin], given.data() + end, &boxes[begin]);
      } else {
        for (std::size_t i = begin; i < end; ++i) boxes[ids[i]] = given[i];
      }
    });
    return sortAll();
  }
  moved.clear();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Aabb& box = boxes[ids[i]];
    if (box == given[i]) continue;
    moved.push_back(ids[i]);
    box = given[i];
  }
  if (!moved.empty()) sortMoved();
}

void HGrid::move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
  Engine& e = *engine_;
  e.requireValid(ids, boxes);
  for (const ProxyId id : ids) e.requireStored(id);
  if (ids.empty()) return;
  e.unhash();
  e.moved = ids;
  for (std::size_t i = 0; i < ids.size(); ++i) e.boxes[ids[i]] = boxes[i];
  try {
    e.sortMoved();
  } catch (...) {
    e.restoreFromLayers();
    throw;
  }
}

std::size_t HGrid::size() const { return engine_->stored; }

double HGrid::edge(int level) const { return engine_->finest_edge * std::pow(GridScale::kRatio, level); }

int HGrid::levelFor(const Aabb& box) const {
  const double side = (box.max - box.min).maxCoeff();
  double edge = engine_->finest_edge;
  int level = 0;
  for (; level < GridScale::kLevels && side > edge; ++level) edge *= GridScale::kRatio;
  return level;
}

int HGrid::levelOf(ProxyId id) const { return engine_->isStored(id) ? levelFor(engine_->boxes[id]) : -1; }

std::vector<BroadPhaseLevel> HGrid::levels() const {
  std::vector<BroadPhaseLevel> levels;
  for (int level = 0; level < GridScale::kLevels; ++level) levels.push_back({edge(level), 0});
  levels.push_back({std::numeric_limits<double>::infinity(), 0});
  for (ProxyId id = 0; id < engine_->layer_of.size(); ++id) {
    if (engine_->isStored(id)) ++levels[static_cast<std::size_t>(levelFor(engine_->boxes[id]))].boxes;
  }
  return levels;
}

std::size_t HGrid::bytes() const {
  const Engine& e = *engine_;
  std::size_t sum = sizeof(Engine) + e.boxes.capacity() * sizeof(Aabb) + e.layer_of.capacity() +
                    e.fixed.capacity() / 8 + e.moved.capacity() * sizeof(ProxyId) +
                    e.scratch.copies.capacity() * sizeof(Aabb) +
                    (e.scratch.cells.capacity() + e.scratch.counts.capacity()) * sizeof(std::uint32_t);
  for (const Layer& layer : e.layers) sum += layer.bytes();
  sum += e.singles.bytes();
  for (const std::vector<ProxyId>& ids : e.members) sum += ids.capacity() * sizeof(ProxyId);
  return sum;
}

void HGrid::checkInvariants() const {
  Engine& e = *engine_;
  const auto require = [](bool holds, const char* invariant) {
    if (!holds) throw std::logic_error(std::string("HGrid: this invariant is violated: ") + invariant);
  };
  std::size_t stored = 0, in_layers = 0;
  for (ProxyId id = 0; id < e.layer_of.size(); ++id) {
    if (e.layer_of[id] == Engine::kAbsent) continue;
    ++stored;
    require(isValid(e.boxes[id]), "each stored box is finite, with min <= max");
  }
  require(stored == e.stored, "size() is the number of stored boxes");
  std::vector<bool> seen(e.layer_of.size());
  e.singles.checkInvariants();
  e.singles.visitAll([&](ProxyId id, std::uint32_t place) {
    ++in_layers;
    require(e.layer_of[id] == Engine::kLoose && e.positions()[id] == place, "a box of the table is loose");
    require(e.boxes[id] == e.singles.boxAt(place), "the table has the coordinates of its boxes");
  });
  for (std::size_t number = 0; number < e.layers.size(); ++number) {
    if (number == Engine::kLoose && e.isHashed()) continue;
    const Layer& layer = e.layers[number];
    layer.checkInvariants(e.boxes);
    for (std::uint32_t i = 0; i < layer.size(); ++i) {
      if (layer.isWithdrawn(i)) continue;
      const ProxyId id = layer.ids()[i];
      require(e.layer_of[id] == number, "a box is in the layer that layer_of names");
      require(!seen[id], "a box is in one layer only");
      require(!e.located[number] || e.positions()[id] == i, "the position that is stored for a box is right");
      seen[id] = true;
      ++in_layers;
    }
  }
  require(in_layers == stored, "every stored box is in a layer");
}

}  // namespace hgrid
