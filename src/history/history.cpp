// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/history/history.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "history/kept_parts.h"
#include "history/snapshot_record.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostWaiting = 4;     // ticks that wait for compact(); each keeps a snapshot with its broad phase
constexpr std::size_t kEntryOverhead = 64;  // [bytes] of a shared object and of its place in a deque
constexpr std::size_t kMostRestored = 4;    // past snapshots that are kept for the next queries

}  // namespace

struct History::State {
  /// A kept tick.
  struct Entry {
    Time stamp{0};
    std::uint64_t sequence = 0;
    std::uint64_t replaces_from = 0;  // sequence of the first of the ticks with this stamp; the later ones replaced it
    std::shared_ptr<const void> note;
    std::size_t own_bytes = 0;             // [bytes] of the entry and its note
    std::shared_ptr<const Snapshot> live;  // null: `record` has replaced it
    std::shared_ptr<const SnapshotRecord> record;
    std::shared_ptr<const Snapshot> restored;  // null: not made again, or dropped since then
    std::size_t restored_bytes = 0;
    std::mutex restoring;  // held while a query makes `restored`
  };
  using Entries = std::deque<std::shared_ptr<Entry>>;

  explicit State(const HistoryLimits& given) : limits(given) {}

  const HistoryLimits limits;

  // All threads use these members, with the mutex. It is held only for a few operations, so that add() never waits.
  mutable std::mutex mutex;
  Entries entries;            // all of one epoch, the oldest first; the first `compacted` entries have a record
  std::size_t compacted = 0;  // number of entries with a record
  std::uint64_t epoch = 0;
  std::uint64_t generation = 0;                  // how often all entries were dropped
  std::vector<Entries> garbage;                  // dropped entries, which compact() destroys
  std::vector<std::shared_ptr<Entry>> restored;  // entries with a restored snapshot, the one used last is at the end
  std::size_t restored_bytes = 0, kept_bytes = 0;
  std::uint64_t dropped = 0, skipped = 0;

  // Only compact() uses these members.
  KeptParts parts;
  std::size_t record_bytes = 0;
  std::uint64_t seen_generation = 0;
  std::shared_ptr<const SnapshotRecord> last;  // the next record shares with it; it may be dropped already

  void dropAll();
  std::shared_ptr<const Snapshot> forgetRestored(std::shared_ptr<Entry> entry);
  bool compactNext();
  void limit(Time newest);
  std::shared_ptr<const Snapshot> snapshotOf(const std::shared_ptr<Entry>& entry);
};

History::History(const HistoryLimits& limits) : state_(std::make_unique<State>(limits)) {}
History::~History() = default;

/// Drops all entries without destroying them, which would take long. The caller holds the mutex.
void History::State::dropAll() {
  garbage.emplace_back();
  garbage.back().swap(entries);
  restored.clear();
  restored_bytes = kept_bytes = compacted = 0;
  ++generation;
}

/// Takes an entry out of the list of entries with a restored snapshot. The caller holds the mutex.
/// @returns the snapshot, so that it is destroyed after the mutex was released; null if the entry has none
std::shared_ptr<const Snapshot> History::State::forgetRestored(std::shared_ptr<Entry> entry) {
  const auto found = std::find(restored.begin(), restored.end(), entry);
  if (found == restored.end()) return nullptr;
  restored.erase(found);
  restored_bytes -= entry->restored_bytes;
  return std::move(entry->restored);
}

void History::add(std::shared_ptr<const Snapshot> snapshot, std::shared_ptr<const void> note, std::size_t note_bytes) {
  State& s = *state_;
  const auto entry = std::make_shared<State::Entry>();
  entry->stamp = snapshot->stamp();
  entry->sequence = entry->replaces_from = snapshot->sequence();
  entry->note = std::move(note);
  entry->own_bytes = sizeof(State::Entry) + kEntryOverhead + note_bytes;
  const std::lock_guard<std::mutex> lock(s.mutex);
  if (snapshot->epoch() != s.epoch) s.dropAll();
  s.epoch = snapshot->epoch();
  if (s.entries.size() - s.compacted >= kMostWaiting) {
    ++s.skipped;
    return;
  }
  entry->live = std::move(snapshot);
  s.entries.push_back(entry);
}

void History::clear() {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->dropAll();
}

/// Makes the oldest waiting entry compact. @returns false if no entry waits
bool History::State::compactNext() {
  std::vector<Entries> destroyed;
  std::shared_ptr<Entry> next;
  std::shared_ptr<Entry> replaced;  // the entry before `next`, if it has the same stamp: no query can ask for it
  std::shared_ptr<const Snapshot> live, restored_before;
  const SnapshotRecord* before = nullptr;  // the record of the entry that will precede `next`; null: there is none
  {
    const std::lock_guard<std::mutex> lock(mutex);
    destroyed.swap(garbage);
    if (seen_generation != generation) {
      seen_generation = generation;
      parts = {};
      record_bytes = 0;
      last.reset();
    }
    if (compacted == entries.size()) return false;
    next = entries[compacted];
    live = next->live;
    if (compacted > 0 && entries[compacted - 1]->stamp == next->stamp) replaced = entries[compacted - 1];
    const std::size_t kept = replaced ? compacted - 1 : compacted;
    if (kept > 0) before = entries[kept - 1]->record.get();
  }
  destroyed.clear();
  const auto record = std::make_shared<const SnapshotRecord>(*live, last.get());
  const Time newest = live->stamp();
  parts.setNewest(record->structure(), record->cells());
  parts.use(record->structure(), record->cells());
  record_bytes += next->own_bytes + record->bytesBeside(before);
  if (replaced) {
    record_bytes -= replaced->own_bytes + replaced->record->bytesBeside(before);
    parts.release(replaced->record->structure(), replaced->record->cells());
  }
  last = record;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (generation != seen_generation) return true;  // all entries were dropped meanwhile
    next->record = record;
    next->live.reset();  // `live` destroys the snapshot after the mutex was released
    if (replaced) {
      next->replaces_from = replaced->replaces_from;
      restored_before = forgetRestored(replaced);
      entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(compacted - 1));
    } else {
      ++compacted;
    }
  }
  limit(newest);
  return true;
}

/// Drops the entries that are beyond the limits. Does not hold the mutex while it counts bytes or destroys entries.
void History::State::limit(Time newest) {
  for (;;) {
    std::shared_ptr<Entry> oldest;
    std::shared_ptr<const Snapshot> destroyed;
    std::shared_ptr<const SnapshotRecord> next;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      if (generation != seen_generation) return;  // all entries were dropped meanwhile
      kept_bytes = record_bytes + parts.bytes();
      const bool too_old = compacted > 1 && entries[1]->stamp <= newest - limits.span;
      const bool too_large = kept_bytes + restored_bytes > limits.bytes;
      if (!too_old && too_large && !restored.empty()) {
        destroyed = forgetRestored(restored.front());
        continue;
      }
      if (!too_old && (!too_large || compacted == 0)) return;
      if (!too_old) ++dropped;
      oldest = entries.front();
      destroyed = forgetRestored(oldest);
      entries.pop_front();
      if (--compacted > 0) next = entries.front()->record;
    }
    record_bytes -= oldest->own_bytes + oldest->record->bytesBeside(next.get());
    parts.release(oldest->record->structure(), oldest->record->cells());
  }
}

void History::compact() {
  State& s = *state_;
  try {
    while (s.compactNext()) {
    }
  } catch (...) {
    clear();  // the sums of bytes may be wrong now; the next call begins again
    throw;
  }
}

/// Returns the snapshot of an entry. Makes it again if its record has replaced it.
std::shared_ptr<const Snapshot> History::State::snapshotOf(const std::shared_ptr<Entry>& entry) {
  const std::lock_guard<std::mutex> restoring(entry->restoring);
  std::shared_ptr<const SnapshotRecord> record;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (entry->live) return entry->live;
    const auto known = std::find(restored.begin(), restored.end(), entry);
    if (known != restored.end()) {
      std::rotate(known, known + 1, restored.end());
      return entry->restored;
    }
    record = entry->record;
  }
  std::size_t bytes = 0;
  std::shared_ptr<const Snapshot> snapshot = record->restore(bytes);
  std::shared_ptr<const Snapshot> destroyed;  // after the mutex was released
  const std::lock_guard<std::mutex> lock(mutex);
  const auto at =
      std::lower_bound(entries.begin(), entries.end(), entry->sequence,
                       [](const auto& other, std::uint64_t sequence) { return other->sequence < sequence; });
  const bool is_kept = at != entries.end() && *at == entry;
  if (!is_kept || kept_bytes + restored_bytes + bytes > limits.bytes) return snapshot;
  if (restored.size() == kMostRestored) {
    destroyed = forgetRestored(restored.front());
  }
  restored.push_back(entry);
  entry->restored = snapshot;
  entry->restored_bytes = bytes;
  restored_bytes += bytes;
  return snapshot;
}

PastTick History::find(Time stamp, const Snapshot& newest) const {
  State& s = *state_;
  PastTick past;
  std::shared_ptr<State::Entry> entry;
  {
    const std::lock_guard<std::mutex> lock(s.mutex);
    if (s.epoch != newest.epoch()) return past;
    const auto later = std::upper_bound(s.entries.begin(), s.entries.end(), stamp,
                                        [](Time time, const auto& other) { return time < other->stamp; });
    if (later == s.entries.begin()) return past;
    entry = *std::prev(later);
    const std::uint64_t next = later == s.entries.end() ? newest.sequence() : (*later)->replaces_from;
    past.outcome = entry->sequence + 1 == next ? PastTick::Outcome::found : PastTick::Outcome::skipped;
  }
  if (past.outcome != PastTick::Outcome::found) return past;
  past.note = entry->note;
  past.snapshot = s.snapshotOf(entry);
  return past;
}

HistoryExtent History::extent() const {
  const State& s = *state_;
  const std::lock_guard<std::mutex> lock(s.mutex);
  HistoryExtent extent;
  extent.ticks = s.entries.size();
  extent.bytes = s.kept_bytes + s.restored_bytes;
  extent.epoch = s.epoch;
  if (!s.entries.empty()) {
    extent.begin = s.entries.front()->stamp;
    extent.end = s.entries.back()->stamp;
  }
  extent.dropped = s.dropped;
  extent.skipped = s.skipped;
  return extent;
}

}  // namespace hgrid
