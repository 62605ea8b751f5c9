// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/tick_jobs.h"

#include <algorithm>
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
  const auto done = std::make_shared<std::promise<void>>();  // shared: this call may return before the job is done
  std::future<void> result = done->get_future();
  add([job, done](World& world) {
    try {
      job(world);
      done->set_value();
    } catch (...) {
      done->set_exception(std::current_exception());
    }
  });
  const auto deadline = std::chrono::steady_clock::now() + patience_;
  while (result.wait_for(std::min(kPause, patience_)) != std::future_status::ready) {
    if (is_ending_()) throw Refusal(Code::busy, "the node is shutting down; it makes no more changes");
    if (std::chrono::steady_clock::now() > deadline) {
      throw Refusal(Code::busy,
                    "no tick has made this change within " + secondsOf(patience_) + "; a later tick may still make it");
    }
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
