// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests jobs for which another thread waits, and jobs that fail.
#include "src/node/tick/tick_jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/world/world.h"
#include "test/node/support/settings.h"

namespace hgrid {
namespace test {
namespace {

/// An empty world, and a thread that runs its jobs without pause.
class Ticking {
 public:
  explicit Ticking(TickJobs& jobs)
      : thread_([this, &jobs] {
          while (!stop_) jobs.doAll(world_, ledger_);
        }) {}
  ~Ticking() {
    stop_ = true;
    thread_.join();
  }
  std::thread::id thread() const { return thread_.get_id(); }
  const World& world() const { return world_; }

 private:
  Params params_;
  Ledger ledger_;
  World world_{settingsOf(params_), false, 1, ledger_, makeCoreNarrowPhase()};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

Refusal refusalOfJob(TickJobs& jobs, const TickJobs::Job& job) {
  try {
    jobs.run(job);
  } catch (const Refusal& refusal) {
    return refusal;
  }
  return {Code::ok, ""};
}

TEST(TickJobsRun, ReturnsWhenTheTickThreadHasDoneTheJob) {
  TickJobs jobs;
  const Ticking ticking(jobs);
  std::thread::id done_by;
  const World* with = nullptr;
  jobs.run([&](World& world) {
    done_by = std::this_thread::get_id();
    with = &world;
  });
  EXPECT_EQ(done_by, ticking.thread());
  EXPECT_EQ(with, &ticking.world());
}

TEST(TickJobsRun, ThrowsWhatTheJobThrowsAndDoesItOnce) {
  TickJobs jobs;
  const Ticking ticking(jobs);
  int times = 0;
  const Refusal refusal = refusalOfJob(jobs, [&](World&) {
    ++times;
    throw Refusal(Code::limit, "too many");
  });
  EXPECT_EQ(refusal.code(), Code::limit);
  EXPECT_THROW(jobs.run([](World&) { throw std::runtime_error("a fault"); }), std::runtime_error);
  jobs.run([](World&) {});
  EXPECT_EQ(times, 1);
}

TEST(TickJobsRun, IsGivenUpIfNoTickComes) {
  TickJobs jobs([] { return false; }, std::chrono::milliseconds(20));
  const Refusal refusal = refusalOfJob(jobs, [](World&) {});
  EXPECT_EQ(refusal.code(), Code::busy);
  EXPECT_STREQ(refusal.what(), "no tick has started within 0.02 s; this change will not be made: request it again");
}

TEST(TickJobsRun, NeverDoesARefusedJobLater) {
  TickJobs jobs([] { return false; }, std::chrono::milliseconds(20));
  int refused = 0, accepted = 0;
  EXPECT_EQ(refusalOfJob(jobs, [&](World&) { ++refused; }).code(), Code::busy);
  jobs.add("a", [&](World&) { ++accepted; });  // the queue keeps its order
  const Params params;
  Ledger ledger;
  World world(settingsOf(params), false, 1, ledger, makeCoreNarrowPhase());
  jobs.doAll(world, ledger);
  EXPECT_EQ(accepted, 1);
  EXPECT_EQ(refused, 0);
}

/// Claim: a job that was refused while a tick was at an earlier job is not done by this tick either.
TEST(TickJobsRun, IsNotDoneIfItWasRefusedWhileATickWasAtAnEarlierJob) {
  TickJobs jobs([] { return false; }, std::chrono::milliseconds(500));
  std::promise<void> refusal_came;
  jobs.add("a", [&](World&) { refusal_came.get_future().wait(); });
  int refused = 0;
  Code code = Code::ok;
  std::thread asking([&] { code = refusalOfJob(jobs, [&](World&) { ++refused; }).code(); });
  while (jobs.waiting() < 2) std::this_thread::yield();
  const Params params;
  Ledger ledger;
  World world(settingsOf(params), false, 1, ledger, makeCoreNarrowPhase());
  std::thread tick([&] { jobs.doAll(world, ledger); });
  asking.join();
  refusal_came.set_value();
  tick.join();
  EXPECT_EQ(code, Code::busy);
  EXPECT_EQ(refused, 0);
}

/// Claim: while no tick comes, the queue stays bounded. A note replaces the note of the same key, and a job that is
/// given up leaves the queue.
TEST(TickJobs, DoNotPileUpWhileNoTickComes) {
  TickJobs jobs([] { return false; }, std::chrono::milliseconds(1));
  std::string done;
  for (int i = 0; i < 1000; ++i) {
    for (const char* key : {"a", "b"}) {
      jobs.add(key, [&done, key, i](World&) { done += key + std::to_string(i) + " "; });
    }
    if (i % 100 != 0) continue;
    EXPECT_EQ(refusalOfJob(jobs, [&](World&) { done += "refused "; }).code(), Code::busy);
  }
  EXPECT_EQ(jobs.waiting(), 2u);
  Params params;
  Ledger ledger;
  World world(settingsOf(params), false, 1, ledger, makeCoreNarrowPhase());
  jobs.doAll(world, ledger);
  EXPECT_EQ(done, "a999 b999 ");
}

/// Claim: a note that a tick could not take is not repeated once a newer note of the same key came.
TEST(TickJobs, ThatFailAreReplacedByANewerOneOfTheSameKey) {
  Params params;
  Ledger ledger;
  World world(settingsOf(params), false, 1, ledger, makeCoreNarrowPhase());
  TickJobs jobs;
  std::string done;
  jobs.add("a", [](World&) { throw std::runtime_error("a fault"); });
  jobs.doAll(world, ledger);
  jobs.add("b", [&](World&) { done += "b"; });
  jobs.add("a", [&](World&) { done += "a"; });
  jobs.doAll(world, ledger);
  jobs.doAll(world, ledger);
  EXPECT_EQ(done, "ba");
  EXPECT_EQ(ledger.counters().at("job.failed.INTERNAL"), 1u);
}

TEST(TickJobsRun, WaitsForAJobThatHasStartedHoweverLongItTakes) {
  TickJobs jobs([] { return false; }, std::chrono::milliseconds(200));  // enough for a busy machine to start the job
  const Ticking ticking(jobs);
  std::atomic<bool> done{false};
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
  const Refusal refusal = refusalOfJob(jobs, [&](World&) {
    while (std::chrono::steady_clock::now() < until) std::this_thread::yield();
    done = true;
  });
  EXPECT_EQ(refusal.code(), Code::ok) << refusal.what();
  EXPECT_TRUE(done) << "an answer BUSY would have been wrong";
}

TEST(TickJobs, AreDoneAgainUntilTheySucceed) {
  const Params params;
  Ledger ledger;
  World world(settingsOf(params), false, 1, ledger, makeCoreNarrowPhase());
  TickJobs jobs;
  int tries = 0, others = 0;
  jobs.add("a", [&](World&) {
    if (++tries < 3) throw std::runtime_error("not yet");
  });
  jobs.add("b", [&](World&) { ++others; });
  for (int tick = 0; tick < 5; ++tick) jobs.doAll(world, ledger);
  EXPECT_EQ(tries, 3);
  EXPECT_EQ(others, 1);
  EXPECT_EQ(ledger.counters().at("job.failed.INTERNAL"), 2u);
}

TEST(TickJobsRun, IsGivenUpIfTheNodeIsAboutToEnd) {
  std::atomic<int> looks{0};
  TickJobs jobs([&] { return ++looks > 2; });
  const Refusal refusal = refusalOfJob(jobs, [](World&) {});
  EXPECT_EQ(refusal.code(), Code::busy);
  EXPECT_STREQ(refusal.what(), "the node is shutting down; it makes no more changes");
  EXPECT_EQ(looks, 3) << "run() checks repeatedly whether the node is shutting down";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
