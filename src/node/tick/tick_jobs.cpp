// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/tick_jobs.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include "node/health/guarded.h"

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kPause{50};  // pause between two checks whether the node is shutting down

std::string secondsOf(std::chrono::milliseconds duration) {
  return text(std::chrono::duration<double>(duration).count()) + " s";
}

}  // namespace

TickJobs::TickJobs(std::function<bool()> is_ending, std::chrono::milliseconds patience, std::function<void()> wake)
    : is_ending_(std::move(is_ending)), patience_(patience), wake_(std::move(wake)) {}

void TickJobs::add(const std::string& key, Job job) { put(key, std::move(job)); }

/// Adds a job. Removes the waiting job of the same key, unless the key is empty. @returns the number of the job
std::uint64_t TickJobs::put(const std::string& key, Job job) {
  std::uint64_t number = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    added_.reserve(added_.size() + 1);
    const auto same = [&](const Waiting& waiting) { return !key.empty() && waiting.key == key; };
    Waiting added{key, ++last_number_, std::move(job)};
    number = added.number;
    added_.erase(std::remove_if(added_.begin(), added_.end(), same), added_.end());
    added_.push_back(std::move(added));
  }
  wake_();
  return number;
}

/// Removes a job that no tick has begun to do.
void TickJobs::remove(std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto same = [&](const Waiting& waiting) { return waiting.number == number; };
  added_.erase(std::remove_if(added_.begin(), added_.end(), same), added_.end());
}

std::size_t TickJobs::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return added_.size();
}

void TickJobs::run(const Job& job) {
  enum class State { waiting, started, withdrawn };
  struct Request {
    std::atomic<State> state{State::waiting};
    std::promise<void> done;
    /// If the request is waiting, sets its state to `next` and returns true. Two threads may try, but only one
    /// succeeds.
    bool leaveWaiting(State next) {
      State expected = State::waiting;
      return state.compare_exchange_strong(expected, next);
    }
  };
  const auto request = std::make_shared<Request>();  // shared: this call may return while the job is in the queue
  std::future<void> result = request->done.get_future();
  const std::uint64_t number = put("", [job, request](World& world) {
    if (!request->leaveWaiting(State::started)) return;
    try {
      job(world);
      request->done.set_value();
    } catch (...) {
      request->done.set_exception(std::current_exception());
    }
  });
  const auto deadline = std::chrono::steady_clock::now() + patience_;
  while (result.wait_for(std::min(kPause, patience_)) != std::future_status::ready) {
    const bool ending = is_ending_();
    if (!ending && std::chrono::steady_clock::now() <= deadline) continue;
    if (!request->leaveWaiting(State::withdrawn)) continue;  // a tick is doing the job now
    remove(number);
    throw Refusal(Code::busy, ending ? "the node is shutting down; it makes no more changes"
                                     : "no tick has started within " + secondsOf(patience_) +
                                           "; this change will not be made: request it again");
  }
  result.get();
}

void TickJobs::doAll(World& world, Ledger& ledger) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pending_.reserve(pending_.size() + added_.size());
    const auto replaced = [&](const Waiting& old) {
      return std::any_of(added_.begin(), added_.end(),
                         [&](const Waiting& added) { return !old.key.empty() && added.key == old.key; });
    };
    pending_.erase(std::remove_if(pending_.begin(), pending_.end(), replaced), pending_.end());
    pending_.insert(pending_.end(), std::make_move_iterator(added_.begin()), std::make_move_iterator(added_.end()));
    added_.clear();
  }
  const auto succeeds = [&](const Waiting& one) { return !guarded(ledger, "job.failed", [&] { one.job(world); }); };
  pending_.erase(std::remove_if(pending_.begin(), pending_.end(), succeeds), pending_.end());
}

}  // namespace hgrid
