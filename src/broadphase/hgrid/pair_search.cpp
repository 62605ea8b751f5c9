// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <atomic>
#include <new>

#include "broadphase/hgrid/engine.h"
#include "broadphase/hgrid/found_boxes.h"
#include "broadphase/hgrid/position_writer.h"

namespace hgrid {
namespace {

constexpr std::uint32_t kTask = 1024;  // boxes per task; a multiple of kBlock in output_body.h

bool notBothFixed(const void* fixed, ProxyId first, ProxyId second) {
  const auto& is = *static_cast<const std::vector<bool>*>(fixed);
  return !(first < is.size() && is[first] && second < is.size() && is[second]);
}

/// Leaves out the pairs of two fixed boxes, then the pairs that the overlap filter does not keep.
struct CombinedFilter {
  const OverlapFilter& overlaps;
  const std::vector<bool>* fixed;  // by id; null if all fixed boxes are in the fixed layer

  /// Filters the pairs with indices from .. end - 1 and moves the kept pairs together, from index `from` on.
  /// @returns the end of the kept pairs
  std::size_t keep(std::vector<ProxyPair>& pairs, std::size_t from, std::size_t end) const {
    ProxyPair *const first = pairs.data() + from, *last = pairs.data() + end;
    if (fixed != nullptr) last = OverlapFilter::of<notBothFixed>(fixed)(first, last);
    return static_cast<std::size_t>(overlaps(first, last) - pairs.data());
  }
};

/// Counts the pairs and overlaps that all threads of a search find. Says whether they exceed the bound.
class Tally {
 public:
  /// @param pairs, overlaps  numbers of pairs and overlaps that were found before this search and count as well
  Tally(const PairBound& bound, std::size_t pairs, std::size_t overlaps)
      : bound_(bound),
        pairs_(pairs),
        overlaps_(overlaps),
        exceeded_(pairs > bound.pairs || overlaps > bound.overlaps) {}

  void add(std::size_t pairs, std::size_t overlaps) {
    const std::size_t all_pairs = pairs_.fetch_add(pairs, std::memory_order_relaxed) + pairs;
    const std::size_t all_overlaps = overlaps_.fetch_add(overlaps, std::memory_order_relaxed) + overlaps;
    if (all_pairs > bound_.pairs || all_overlaps > bound_.overlaps) exceeded_.store(true, std::memory_order_relaxed);
  }
  bool exceeded() const { return exceeded_.load(std::memory_order_relaxed); }
  std::size_t overlaps() const { return overlaps_.load(std::memory_order_relaxed); }
  const PairBound& bound() const { return bound_; }

 private:
  const PairBound bound_;
  std::atomic<std::size_t> pairs_, overlaps_;
  std::atomic<bool> exceeded_;
};

/// Lets kernels write pairs into a vector, after the first `used` pairs.
///
/// The vector grows until it has room for kRoom pairs more than the bound allows. When the vector is full, the pairs
/// are filtered to make room. When the pairs exceed the bound, Sink::full asks the kernels to stop. PairWriter never
/// shrinks the vector.
class PairWriter {
 public:
  PairWriter(std::vector<ProxyPair>& pairs, std::size_t used, const CombinedFilter& filter, Tally& tally)
      : pairs_(pairs), wanted_end_(used), filter_(filter), tally_(tally) {
    if (pairs_.size() < used + kLeast) pairs_.resize(used + kLeast);
    sink_.owner = this;
    sink_.grow = grow;
    point(used);
  }
  PairWriter(const PairWriter&) = delete;
  PairWriter& operator=(const PairWriter&) = delete;

  kernels::PairSink* sink() { return &sink_; }
  /// Filters the pairs that were written since the last call.
  /// @returns the end of the kept pairs; meaningless if the bound is exceeded
  std::size_t filter() {
    if (tally_.exceeded()) return wanted_end_;
    const std::size_t end = used(), begin = wanted_end_;
    wanted_end_ = filter_.keep(pairs_, begin, end);
    tally_.add(wanted_end_ - begin, end - begin);
    return wanted_end_;
  }

 private:
  static constexpr std::size_t kRoom = 65536;  // least number of pairs that fit in between two calls of filter()
  static constexpr std::size_t kLeast = 16;    // a kernel needs room for so many pairs before it writes

  kernels::Pair* data() const { return reinterpret_cast<kernels::Pair*>(pairs_.data()); }
  std::size_t used() const { return static_cast<std::size_t>(sink_.next - data()); }
  void point(std::size_t used) {
    sink_.next = data() + used;
    sink_.limit = data() + pairs_.size();
  }
  void makeRoom() {
    const std::size_t bound = tally_.bound().pairs;
    const std::size_t largest = bound < PairBound::kNone - kRoom ? bound + kRoom : PairBound::kNone;
    if (pairs_.size() + kLeast <= largest) {
      const std::size_t end = used();
      // Stays within the capacity if it can, so nothing is allocated. Does not use all of it at once, because resize()
      // writes zeros.
      const std::size_t most = pairs_.capacity() - pairs_.size() >= kLeast ? pairs_.capacity() : largest;
      pairs_.resize(std::min({2 * pairs_.size(), most, largest}));
      return point(end);
    }
    point(filter());
    if (!tally_.exceeded()) return;
    sink_.full = true;
    point(0);
  }
  static void grow(kernels::PairSink* sink) { static_cast<PairWriter*>(sink->owner)->makeRoom(); }

  std::vector<ProxyPair>& pairs_;
  std::size_t wanted_end_;  // all pairs before this index are filtered and counted
  const CombinedFilter& filter_;
  Tally& tally_;
  kernels::PairSink sink_{};
};

/// Adds tasks that test all boxes of the level `asking` against the level `asked`. If `asked` is null, they are tested
/// against each other.
void addTask(std::vector<SearchTask>& tasks, const kernels::Level& asking, const kernels::Level* asked) {
  for (std::uint32_t begin = asking.begin; begin < asking.end; begin += kTask) {
    tasks.push_back({&asking, asked, begin, std::min(begin + kTask, asking.end)});
    tasks.back().boxes = tasks.back().end - begin;
  }
}

/// Decides in which direction two levels are tested. Returns true if testing boxes of `first` against the cells of
/// `second` visits fewer rows of cells than testing boxes of `second` against the cells of `first`.
/// @param boxes, others  numbers of boxes of `first` and of `second` that would be tested
bool firstAsks(const kernels::Level& first, std::size_t boxes, const kernels::Level& second, std::size_t others) {
  return static_cast<double>(boxes) * rowsAsked(first, second) <=
         static_cast<double>(others) * rowsAsked(second, first);
}

/// Returns which share of the volume of a box is within another box. They overlap.
double shareWithin(const kernels::Box& other, const kernels::Box& box) {
  double share = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const float length = box.max[axis] - box.min[axis];
    const float within = std::min(box.max[axis], other.max[axis]) - std::max(box.min[axis], other.min[axis]);
    if (within < length) share *= static_cast<double>(within) / static_cast<double>(length);
  }
  return share;
}

/// Adds tasks that test the boxes of two levels against each other.
void addAcross(std::vector<SearchTask>& tasks, const kernels::Level& first, const kernels::Level& second) {
  if (first.begin == first.end || second.begin == second.end) return;
  if (firstAsks(first, first.end - first.begin, second, second.end - second.begin)) {
    addTask(tasks, first, &second);
  } else {
    addTask(tasks, second, &first);
  }
}

/// Adds tasks for the regions of a layer. Each task gets as many regions as are needed for kTask boxes.
void addRegions(std::vector<SearchTask>& tasks, const Layer& layer, const Layer* other) {
  const std::size_t regions = layer.regions().size();
  SearchTask task{};
  task.layer = &layer;
  task.other = other;
  for (std::size_t number = 0; number < regions; ++number) {
    const kernels::Region& region = layer.regions().region(number);
    for (std::uint32_t i = 0; i < region.levels; ++i) {
      const kernels::Level& level = layer.levels()[region.first_level + i];
      task.boxes += level.end - level.begin;
    }
    task.end = static_cast<std::uint32_t>(number + 1);
    if (task.boxes < kTask && number + 1 < regions) continue;
    tasks.push_back(task);
    task.begin = task.end;
    task.boxes = 0;
  }
}

/// Adds tasks that test each level of a layer against itself and against each later level (Ericson 2005, 7.2).
void addWithin(std::vector<SearchTask>& tasks, const Layer& layer) {
  if (layer.isDivided()) return addRegions(tasks, layer, nullptr);
  const std::vector<kernels::Level>& levels = layer.levels();
  for (std::size_t level = 0; level < levels.size(); ++level) {
    addTask(tasks, levels[level], nullptr);
    for (std::size_t later = level + 1; later < levels.size(); ++later) {
      addAcross(tasks, levels[level], levels[later]);
    }
  }
}

/// Adds tasks that test the boxes of all regions of a layer against one level of another layer. Successive levels that
/// overlap `asked` share tasks.
void addRegionsAcross(std::vector<SearchTask>& tasks, const Layer& layer, const kernels::Level& asked) {
  const std::vector<kernels::Level>& levels = layer.levels();
  const kernels::Level* first = nullptr;
  std::uint32_t begin = 0;
  const auto ask = [&](std::uint32_t end) {
    for (; first != nullptr && begin < end; begin += kTask) {
      tasks.push_back({first, &asked, begin, std::min(begin + kTask, end)});
      tasks.back().boxes = tasks.back().end - begin;
    }
    first = nullptr;
  };
  for (const kernels::Level& level : levels) {
    if (!overlap(level.around, asked.around)) {
      ask(level.begin);
    } else if (first == nullptr) {
      first = &level;
      begin = level.begin;
    }
  }
  ask(levels.back().end);
}

/// Adds tasks that test the boxes of two layers against each other.
void addAcross(std::vector<SearchTask>& tasks, const Layer& a, const Layer& b) {
  if (a.levels().empty() || b.levels().empty()) return;
  for (const auto& [some, others] : {std::make_pair(&a, &b), std::make_pair(&b, &a)}) {
    if (some->isDivided() && !others->isDivided() && some->size() <= others->size()) {
      for (const kernels::Level& level : others->levels()) addRegionsAcross(tasks, *some, level);
      return;
    }
  }
  if (a.isDivided() || b.isDivided()) {
    return a.regions().size() >= b.regions().size() ? addRegions(tasks, a, &b) : addRegions(tasks, b, &a);
  }
  for (const kernels::Level& first : a.levels()) {
    for (const kernels::Level& second : b.levels()) addAcross(tasks, first, second);
  }
}

/// Finds the pairs of the boxes in a region.
class RegionSearch {
 public:
  RegionSearch(const kernels::Kernels& kernels, GatheredBoxes& gathered, kernels::PairSink* sink)
      : kernels_(kernels), gathered_(gathered), sink_(sink) {}

  /// Finds the pairs of a region's boxes with each other and with the boxes of later regions.
  void within(const Layer& layer, std::uint32_t number) {
    const std::vector<kernels::Level>& levels = layer.levels();
    const kernels::Region& region = layer.regions().region(number);
    const std::uint32_t first = region.first_level, last = first + region.levels;
    for (std::uint32_t i = first; i < last; ++i) {
      kernels_.pairsWithin(&levels[i], levels[i].begin, levels[i].end, sink_);
      for (std::uint32_t coarser = i + 1; coarser < last; ++coarser) meet(levels[i], levels[coarser]);
    }
    meetAll(layer, region, layer, last);
  }

  /// Finds the pairs of a region's boxes with the boxes of another layer.
  void across(const Layer& layer, std::uint32_t number, const Layer& other) {
    meetAll(layer, layer.regions().region(number), other, 0);
  }

 private:
  /// Finds the pairs of a region's boxes with the boxes of the layer `other` on the levels with an index >= `least`.
  void meetAll(const Layer& layer, const kernels::Region& region, const Layer& other, std::uint32_t least) {
    const kernels::LevelSet others = other.levelSet();
    for (std::uint32_t i = 0; i < region.levels; ++i) {
      const kernels::Level& level = layer.levels()[region.first_level + i];
      PositionWriter near(gathered_.levels);
      kernels_.reaching(&others, &level.around, near.sink());
      for (const std::uint32_t number : near) {
        if (number >= least) meet(level, other.levels()[number]);
      }
    }
  }

  /// Finds the pairs of two levels. Only boxes that overlap the bounds of the other level ask. They are counted, and
  /// firstAsks() decides which of them ask. Those of the larger level are not counted if they are likely too many.
  void meet(const kernels::Level& a, const kernels::Level& b) {
    constexpr std::size_t kFew = 8;    // number of boxes; it is cheaper to test so few boxes without a selection
    constexpr std::size_t kMany = 16;  // least number of boxes of the smaller level for which the others are counted
    constexpr std::size_t kTimes = 8;  // the larger level has at most so many times as many boxes if they are counted
    if (sink_->full || !overlap(a.around, b.around)) return;
    const bool a_is_smaller = a.end - a.begin <= b.end - b.begin;
    const kernels::Level &smaller = a_is_smaller ? a : b, &larger = a_is_smaller ? b : a;
    const std::size_t all = smaller.end - smaller.begin, all_others = larger.end - larger.begin;
    if (all <= kFew && firstAsks(smaller, all, larger, all_others))
      return kernels_.pairsAcross(&smaller, smaller.begin, smaller.end, &larger, sink_);
    PositionWriter near(gathered_.positions);
    select(smaller, larger, near);
    if (near.size() == 0) return;
    // Counting the boxes of the larger level takes time. It is worth it only if twice as many as are likely, judged by
    // the volume of the bounds, would ask in less time.
    const double likely = 2.0 * shareWithin(smaller.around, larger.around) * static_cast<double>(all_others);
    const bool is_worth_counting = near.size() >= kMany && all_others <= kTimes * near.size() &&
                                   !firstAsks(smaller, near.size(), larger, static_cast<std::size_t>(likely));
    if (!is_worth_counting && firstAsks(smaller, near.size(), larger, all_others))
      return askSome(smaller, near, larger);
    PositionWriter others(gathered_.other_positions);
    select(larger, smaller, others);
    if (firstAsks(smaller, near.size(), larger, others.size())) {
      askSome(smaller, near, larger);
    } else {
      askSome(larger, others, smaller);
    }
  }

  /// Finds the boxes of `asking` that overlap the bounds of `asked`.
  void select(const kernels::Level& asking, const kernels::Level& asked, PositionWriter& near) const {
    const kernels::LevelSet all = {&asking, 1, nullptr, 0, 0};
    kernels_.overlapping(&all, &asked.around, near.sink());
  }

  /// Finds the pairs of some boxes of `asking` with the boxes of `asked`. @param positions  of these boxes
  void askSome(const kernels::Level& asking, const PositionWriter& positions, const kernels::Level& asked) {
    const std::size_t count = positions.size();
    if (count == 0) return;
    if (count == asking.end - asking.begin) {
      return kernels_.pairsAcross(&asking, asking.begin, asking.end, &asked, sink_);
    }
    kernels::Level some = asking;
    some.stride = count + kReadBeyond;
    some.begin = 0;
    some.end = static_cast<std::uint32_t>(count);
    if (gathered_.bounds.size() < 6 * some.stride) gathered_.bounds.resize(12 * some.stride);
    if (gathered_.ids.size() < some.stride) gathered_.ids.resize(2 * some.stride);
    float* bounds = gathered_.bounds.data();
    std::uint32_t* id = gathered_.ids.data();
    for (const std::uint32_t position : positions) {
      const float* const from = asking.bounds + position;
      for (std::size_t side = 0; side < 6; ++side) bounds[side * some.stride] = from[side * asking.stride];
      *id++ = asking.id[position];
      ++bounds;
    }
    some.bounds = gathered_.bounds.data();
    some.id = gathered_.ids.data();
    kernels_.pairsAcross(&some, some.begin, some.end, &asked, sink_);
  }

  static constexpr std::size_t kReadBeyond = 16;  // positions that kernels may read beyond the last box

  const kernels::Kernels& kernels_;
  GatheredBoxes& gathered_;
  kernels::PairSink* sink_;
};

void perform(const SearchTask& task, const kernels::Kernels& kernels, GatheredBoxes& gathered,
             kernels::PairSink* sink) {
  if (task.layer != nullptr) {
    RegionSearch search(kernels, gathered, sink);
    for (std::uint32_t region = task.begin; region < task.end && !sink->full; ++region) {
      if (task.other == nullptr) {
        search.within(*task.layer, region);
      } else {
        search.across(*task.layer, region, *task.other);
      }
    }
  } else if (task.asked == nullptr) {
    kernels.pairsWithin(task.asking, task.begin, task.end, sink);
  } else {
    kernels.pairsAcross(task.asking, task.begin, task.end, task.asked, sink);
  }
}

/// Performs the tasks. Writes the pairs after the first `used` pairs of the vector, in the order of the tasks.
/// @returns whether these are all pairs; false if they exceed the bound of the tally
bool performAll(SearchBuffers& buffers, const kernels::Kernels& kernels, const CombinedFilter& filter, Tally& tally,
                Workers* workers, std::vector<ProxyPair>& pairs, std::size_t used) {
  std::vector<SearchTask>& tasks = buffers.tasks;
  std::size_t boxes = 0;
  for (const SearchTask& task : tasks) boxes += task.boxes;
  if (workers == nullptr || workers->threads() == 1 || boxes < 2 * kWorthAThread) {
    if (buffers.gathered.empty()) buffers.gathered.resize(1);
    PairWriter writer(pairs, used, filter, tally);
    for (const SearchTask& task : tasks) {
      if (tally.exceeded()) return false;
      perform(task, kernels, buffers.gathered.front(), writer.sink());
    }
    pairs.resize(writer.filter());
    return !tally.exceeded();
  }
  const auto threads = static_cast<std::size_t>(workers->threads());
  buffers.parts.resize(threads);
  buffers.used.assign(threads, 0);
  if (buffers.gathered.size() < threads) buffers.gathered.resize(threads);
  workers->run(tasks.size(), [&](std::size_t number, std::size_t thread) {
    if (tally.exceeded()) return;
    SearchTask& task = tasks[number];
    std::vector<ProxyPair>& part = buffers.parts[thread];
    PairWriter writer(part, buffers.used[thread], filter, tally);
    perform(task, kernels, buffers.gathered[thread], writer.sink());
    task.thread = thread;
    task.first = buffers.used[thread];
    buffers.used[thread] = writer.filter();
    task.found = buffers.used[thread] - task.first;
  });
  if (tally.exceeded()) return false;
  std::size_t total = used;
  for (SearchTask& task : tasks) {
    task.to = total;
    total += task.found;
  }
  if (total > pairs.capacity()) pairs.reserve(total + total / 8);  // room for a few more pairs next time
  pairs.resize(total);
  for (std::vector<ProxyPair>& part : buffers.parts) {
    const std::size_t all = total - used + kTask;
    if (part.capacity() < all) part.reserve(all + all / 4);
  }
  workers->run(tasks.size(), [&](std::size_t number, std::size_t) {
    const SearchTask& task = tasks[number];
    std::copy_n(buffers.parts[task.thread].data() + task.first, task.found, pairs.data() + task.to);
  });
  return true;
}

}  // namespace

void HGrid::Engine::findKept() {
  kept_valid = kept_moving = false;
  buffers.tasks.clear();
  addWithin(buffers.tasks, layers[kResting]);
  addAcross(buffers.tasks, layers[kResting], layers[kFixed]);
  Tally tally(bound, 0, 0);
  kept_valid = performAll(buffers, *loops, {filter, nullptr}, tally, workers.get(), kept, 0);
  kept_overlaps = tally.overlaps();
  if (!kept_valid) kept.clear();
}

bool HGrid::Engine::findPairs(std::vector<ProxyPair>& pairs, const PairBound& up_to) const {
  pairs_wanted.store(true, std::memory_order_relaxed);
  std::unique_lock<std::mutex> lock(search_mutex, std::try_to_lock);
  SearchBuffers own;
  SearchBuffers& used_buffers = lock.owns_lock() ? buffers : own;
  std::vector<SearchTask>& tasks = used_buffers.tasks;
  tasks.clear();
  std::size_t used = 0;
  if (kept_valid) {
    if (pairs.size() < kept.size()) pairs.resize(kept.size());
    if (!kept_dirty) {
      used = static_cast<std::size_t>(std::copy(kept.begin(), kept.end(), pairs.begin()) - pairs.begin());
    } else {
      for (const ProxyPair& pair : kept) {
        pairs[used] = pair;
        used += isKept(pair) ? 1 : 0;
      }
    }
  } else {
    addWithin(tasks, layers[kResting]);
    addAcross(tasks, layers[kResting], layers[kFixed]);
  }
  for (const LayerNumber mobile : {kMoving, kLoose}) {
    if (mobile == kMoving && kept_valid && kept_moving) continue;
    addWithin(tasks, layers[mobile]);
    for (int other = kFixed; other < mobile; ++other)
      addAcross(tasks, layers[mobile], layers[static_cast<std::size_t>(other)]);
  }
  Tally tally(up_to, used, kept_valid ? kept_overlaps : 0);
  const bool complete = performAll(used_buffers, *loops, {filter, fixed_astray ? &fixed : nullptr}, tally,
                                   lock.owns_lock() ? workers.get() : nullptr, pairs, used);
  if (complete && keep_found && lock.owns_lock() && !buffers.found_valid) {
    try {
      // Like the caller's buffer, this one needs room for a few more pairs next time.
      if (buffers.found.capacity() < pairs.size()) buffers.found.reserve(pairs.size() + pairs.size() / 8);
      buffers.found.assign(pairs.begin(), pairs.end());
      buffers.found_overlaps = tally.overlaps();
      buffers.found_valid = true;
    } catch (const std::bad_alloc&) {  // then these pairs will be searched again
    }
  }
  return complete;
}

void HGrid::setPairBound(const PairBound& bound) {
  engine_->bound = bound;
  engine_->dropKept();
}

void HGrid::overlappingPairs(std::vector<ProxyPair>& pairs) const { engine_->findPairs(pairs, PairBound{}); }

// findPairs() may count more overlaps than collectPairs(), but never fewer: it also counts overlaps of boxes that have
// left their layer, and of fixed boxes in other layers. So collectPairs() decides whether the bound is exceeded.
bool HGrid::boundedPairs(std::vector<ProxyPair>& pairs) const {
  return engine_->findPairs(pairs, engine_->bound) || engine_->collectPairs(pairs);
}

}  // namespace hgrid
