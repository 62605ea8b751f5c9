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

#include "node/services/guarded.h"

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kPause{50};  // pause between two checks whether the node is shutting down

std::string secondsOf(std::chrono::milliseconds duration) {
  return text(std::chrono::duration<double>(duration).count()) + " s";
}

}  // namespace

TickJobs::TickJobs(std::function<bool()> is_ending, std::chrono::milliseconds patience)
    : is_ending_(std::move(is_ending)), patience_(patience) {}

void TickJobs::add(Job job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  added_.push_back(std::move(job));
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
  add([job, request](World& world) {
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
    throw Refusal(Code::busy, ending ? "the node is shutting down; it makes no more changes"
                                     : "no tick has started within " + secondsOf(patience_) +
                                           "; this change will not be made: request it again");
  }
  result.get();
}

void TickJobs::doAll(World& world, Ledger& ledger) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pending_.insert(pending_.end(), std::make_move_iterator(added_.begin()), std::make_move_iterator(added_.end()));
    added_.clear();
  }
  const auto succeeds = [&](const Job& job) { return !guarded(ledger, "job.failed", [&] { job(world); }); };
  pending_.erase(std::remove_if(pending_.begin(), pending_.end(), succeeds), pending_.end());
}

}  // namespace hgrid
