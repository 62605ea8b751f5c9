// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loop/tick_loop.h"

#include <algorithm>
#include <utility>

#include "node/health/guarded.h"

namespace hgrid {
namespace {

// Share of the tick period that may be spent on transforms. It is limited, because a flood of transforms must not stop
// the ticks.
constexpr double kShareForTransforms = 0.5;
constexpr std::chrono::seconds kPatience{10};  // how long to wait for the tick that contains a change

}  // namespace

TickLoop::TickLoop(ros::NodeHandle node, const ros::NodeHandle& private_node, const Params& params, World& world,
                   TickJobs& jobs, const TickHistory& history, Stopwatch& stopwatch, NodeHealth& health,
                   TfListener* listener, Ledger& ledger)
    : node_(std::move(node)),
      pace_(params.rate, params.heartbeat, params.follow_data, std::chrono::steady_clock::now()),
      world_(world),
      jobs_(jobs),
      history_(history),
      stopwatch_(stopwatch),
      health_(health),
      ledger_(ledger),
      transforms_(
          node_, private_node, static_cast<std::size_t>(params.max_bodies),
          static_cast<std::size_t>(params.tf_queue_bytes), thisMoment,
          [this](const std::vector<TransformView>& transforms, bool is_static, const std::string& publisher,
                 const Moment& received) {
            bool complete = true;
            guarded(ledger_, "tf.failed",
                    [&] { complete = takeTransforms(transforms, is_static, publisher, received); });
            return complete;
          },
          // A thread of ordinary priority must not delay a tick thread that runs in real time.
          listener, params.realtime == 0, ledger_) {}

std::chrono::nanoseconds TickLoop::work() {
  const TfReader::Hold hold(transforms_);
  const TickPace::Time now = std::chrono::steady_clock::now();
  if (world_.transforms().news().complete()) pace_.noteReason(complete_.value_or(now));
  if (jobs_.waiting() > 0) pace_.noteChange(now);
  if (pace_.due() <= now) {
    const bool late = newest() != nullptr && now - pace_.due() > pace_.period();
    pace_.noteTick(now);
    const std::optional<Refusal> failure = guarded(ledger_, "tick.failed", [&] {
      noteLateness(late);
      makeTick();
    });
    if (failure) pace_.noteReason(now);  // the next tick must not wait for more data
    health_.noteTick(failure);
  }
  return std::max(std::chrono::nanoseconds(0),
                  std::chrono::nanoseconds(pace_.due() - std::chrono::steady_clock::now()));
}

std::shared_ptr<const Tick> TickLoop::tickAfter(const TickJobs::Job& job) {
  struct Ticks {
    std::shared_ptr<const Tick> before, after;
  };
  const auto ticks = std::make_shared<Ticks>();  // shared: run() may end before the job is done
  jobs_.run([this, job, ticks](World& world) {
    ticks->before = newest();
    job(world);
  });
  // `job` runs at the beginning of a tick, before newest() returns this tick. The job below runs at the beginning of a
  // later tick. At this time, the tick of `job` has been published, unless it failed. Then the loop waits for
  // the next tick.
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  try {
    while (std::chrono::steady_clock::now() < deadline) {
      jobs_.run([this, ticks](World&) { ticks->after = newest(); });
      if (ticks->after != ticks->before) return ticks->after;
    }
  } catch (const Refusal& refusal) {
    if (refusal.code() != Code::busy) throw;
  }
  throw Refusal(
      Code::busy,
      "the change was made, but no tick was published in time; check ~bodies and ~rules before you repeat it");
}

/// @returns whether the data of the next tick is complete with these transforms
bool TickLoop::takeTransforms(const std::vector<TransformView>& transforms, bool is_static,
                              const std::string& publisher, const Moment& received) {
  const auto begin = std::chrono::steady_clock::now();
  world_.transforms().take(transforms, is_static, publisher, received);
  const bool completes = !complete_ && world_.transforms().news().complete();
  if (completes) complete_ = received.steady;
  transform_time_ += std::chrono::steady_clock::now() - begin;
  return completes;
}

void TickLoop::makeTick() {
  transforms_.readFor(kShareForTransforms * std::chrono::duration<double>(pace_.period()));
  const auto begin = std::chrono::steady_clock::now();
  jobs_.doAll(world_, ledger_);
  const std::shared_ptr<Tick> made = world_.tick(thisMoment());
  made->history = history_.extent();
  const std::shared_ptr<const Tick> tick = made;
  std::atomic_store(&newest_, tick);
  act(tick);
  complete_.reset();
  health_.noteConflicts(world_.transforms().conflicts());
  const auto end = std::chrono::steady_clock::now();
  stopwatch_.add("tick", end - begin);
  stopwatch_.add("tick.poses", tick->poses_time);
  stopwatch_.add("tick.boxes", tick->times.boxes);
  stopwatch_.add("tick.grid", tick->times.grid);
  stopwatch_.add("tick.pairs", tick->times.pairs);
  stopwatch_.add("tf", std::exchange(transform_time_, std::chrono::nanoseconds(0)));
  stopwatch_.summarize(end);
}

void TickLoop::noteLateness(bool late) {
  health_.noteLateness(late);
  if (late) ledger_.count("tick.late");
}

void TickLoop::act(const std::shared_ptr<const Tick>& tick) {
  for (const Step& step : steps_) {
    const auto begin = std::chrono::steady_clock::now();
    step.act(tick);
    const auto end = std::chrono::steady_clock::now();
    if (!step.timing.empty()) stopwatch_.add(step.timing, end - begin);
    if (step.publishes && complete_) stopwatch_.add("latency", end - *complete_);
  }
}

}  // namespace hgrid
