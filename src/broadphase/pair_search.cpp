// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>

#include "broadphase/engine.h"

namespace hgrid {
namespace {

constexpr std::uint32_t kTask = 1024;         // boxes per task; a multiple of what kernels take at once
constexpr std::size_t kWorthAThread = 16384;  // boxes

/// Lets kernels write into a vector after the first `used` pairs, growing it as they need. The vector ends up as large
/// as it ever was; used() says how far it is filled.
class PairWriter {
 public:
  PairWriter(std::vector<ProxyPair>& pairs, std::size_t used) : pairs_(pairs) {
    pairs_.resize(std::max<std::size_t>({pairs_.capacity(), used + 64, 256}));
    sink_.owner = this;
    sink_.grow = grow;
    point(used);
  }
  PairWriter(const PairWriter&) = delete;
  PairWriter& operator=(const PairWriter&) = delete;

  kernels::PairSink* sink() { return &sink_; }
  std::size_t used() const { return static_cast<std::size_t>(sink_.next - data()); }

 private:
  kernels::Pair* data() const { return reinterpret_cast<kernels::Pair*>(pairs_.data()); }
  void point(std::size_t used) {
    sink_.next = data() + used;
    sink_.limit = data() + pairs_.size();
  }
  static void grow(kernels::PairSink* sink) {
    auto* self = static_cast<PairWriter*>(sink->owner);
    const std::size_t used = self->used();
    self->pairs_.resize(2 * self->pairs_.size());
    self->point(used);
  }

  std::vector<ProxyPair>& pairs_;
  kernels::PairSink sink_{};
};

void addTask(std::vector<SearchTask>& tasks, const kernels::Level& asking, const kernels::Level* asked) {
  for (std::uint32_t begin = asking.begin; begin < asking.end; begin += kTask) {
    tasks.push_back({&asking, asked, begin, std::min(begin + kTask, asking.end)});
  }
}

/// Two levels: those ask whose boxes have fewer rows of cells to look at in all.
void addAcross(std::vector<SearchTask>& tasks, const Layer& a, std::size_t level_a, const Layer& b,
               std::size_t level_b) {
  const kernels::Level &first = a.levels()[level_a], &second = b.levels()[level_b];
  if (first.begin == first.end || second.begin == second.end) return;
  const double first_asks =
      static_cast<double>(first.end - first.begin) * rowsAsked(a.plan(), level_a, b.plan(), level_b, second.reach);
  const double second_asks =
      static_cast<double>(second.end - second.begin) * rowsAsked(b.plan(), level_b, a.plan(), level_a, first.reach);
  if (first_asks <= second_asks) {
    addTask(tasks, first, &second);
  } else {
    addTask(tasks, second, &first);
  }
}

/// Each level with itself and with each coarser one (Ericson 2005, 7.2).
void addWithin(std::vector<SearchTask>& tasks, const Layer& layer) {
  for (std::size_t level = 0; level < layer.levels().size(); ++level) {
    addTask(tasks, layer.levels()[level], nullptr);
    for (std::size_t coarser = level + 1; coarser < layer.levels().size(); ++coarser) {
      addAcross(tasks, layer, level, layer, coarser);
    }
  }
}

void addAcross(std::vector<SearchTask>& tasks, const Layer& a, const Layer& b) {
  for (std::size_t i = 0; i < a.levels().size(); ++i) {
    for (std::size_t j = 0; j < b.levels().size(); ++j) addAcross(tasks, a, i, b, j);
  }
}

void perform(const SearchTask& task, const kernels::Kernels& kernels, kernels::PairSink* sink) {
  if (task.asked == nullptr) {
    kernels.pairsWithin(task.asking, task.begin, task.end, sink);
  } else {
    kernels.pairsAcross(task.asking, task.begin, task.end, task.asked, sink);
  }
}

bool notBothFixed(const void* fixed, ProxyId first, ProxyId second) {
  const auto& is = *static_cast<const std::vector<bool>*>(fixed);
  return !(first < is.size() && is[first] && second < is.size() && is[second]);
}

/// Which pairs are wanted, of all that overlap.
struct Sieve {
  const PairTest& filter;
  const std::vector<bool>* fixed;  // by id; null if fixed boxes stand in their own layer only, which makes no pairs

  /// Leaves out what is not wanted of the pairs from number `from` up to `end`. @returns where they end now
  std::size_t sift(std::vector<ProxyPair>& pairs, std::size_t from, std::size_t end) const {
    for (const PairTest& test : {fixed != nullptr ? PairTest::of<notBothFixed>(fixed) : PairTest{}, filter}) {
      if (test.sift != nullptr) end = from + test.sift(test.context, pairs.data() + from, end - from);
    }
    return end;
  }
};

/// Performs the tasks, all pairs after the first `used` of the vector, in the order of the tasks whoever does them.
void performAll(SearchBuffers& buffers, const kernels::Kernels& kernels, const Sieve& sieve, Workers* workers,
                std::vector<ProxyPair>& pairs, std::size_t used) {
  std::vector<SearchTask>& tasks = buffers.tasks;
  std::size_t boxes = 0;
  for (const SearchTask& task : tasks) boxes += task.end - task.begin;
  if (workers == nullptr || workers->threads() == 1 || boxes < 2 * kWorthAThread) {
    PairWriter writer(pairs, used);
    for (const SearchTask& task : tasks) perform(task, kernels, writer.sink());
    return pairs.resize(sieve.sift(pairs, used, writer.used()));
  }
  const auto threads = static_cast<std::size_t>(workers->threads());
  buffers.parts.resize(threads);
  buffers.used.assign(threads, 0);
  workers->run(tasks.size(), [&](std::size_t number, std::size_t thread) {
    SearchTask& task = tasks[number];
    std::vector<ProxyPair>& part = buffers.parts[thread];
    PairWriter writer(part, buffers.used[thread]);
    perform(task, kernels, writer.sink());
    task.thread = thread;
    task.first = buffers.used[thread];
    buffers.used[thread] = sieve.sift(part, task.first, writer.used());
    task.found = buffers.used[thread] - task.first;
  });
  std::size_t total = used;
  for (SearchTask& task : tasks) {
    task.to = total;
    total += task.found;
  }
  if (total > pairs.capacity()) pairs.reserve(total + total / 8);  // the next time there may be a few more
  pairs.resize(total);
  for (std::vector<ProxyPair>& part : buffers.parts) {
    const std::size_t all = total - used + kTask;
    if (part.capacity() < all) part.reserve(all + all / 4);
  }
  workers->run(tasks.size(), [&](std::size_t number, std::size_t) {
    const SearchTask& task = tasks[number];
    std::copy_n(buffers.parts[task.thread].data() + task.first, task.found, pairs.data() + task.to);
  });
}

}  // namespace

void HGrid::Engine::findKept(std::vector<ProxyPair>& pairs) const {
  buffers.tasks.clear();
  addWithin(buffers.tasks, layers[kResting]);
  addAcross(buffers.tasks, layers[kResting], layers[kFixed]);
  performAll(buffers, kernels::of(isa), {filter, nullptr}, workers.get(), pairs, 0);
}

void HGrid::Engine::findPairs(std::vector<ProxyPair>& pairs) const {
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
        used += place[pair.first] <= kResting && place[pair.second] <= kResting;
      }
    }
  } else {
    addWithin(tasks, layers[kResting]);
    addAcross(tasks, layers[kResting], layers[kFixed]);
  }
  for (const Place mobile : {kMoving, kLoose}) {
    addWithin(tasks, layers[mobile]);
    for (int other = kFixed; other < mobile; ++other)
      addAcross(tasks, layers[mobile], layers[static_cast<std::size_t>(other)]);
  }
  performAll(used_buffers, kernels::of(isa), {filter, fixed_astray ? &fixed : nullptr},
             lock.owns_lock() ? workers.get() : nullptr, pairs, used);
}

void HGrid::overlappingPairs(std::vector<ProxyPair>& pairs) const { engine_->findPairs(pairs); }

}  // namespace hgrid
