// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// No exception of any type leaves a guarded callback, even if there is no memory for the report of the exception.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/health/guarded.h"
#include "src/node/tick/tick_jobs.h"
#include "src/node/world/world.h"
#include "test/node/support/settings.h"

namespace {

thread_local bool g_no_memory = false;  // while true, every operator new of this thread throws

void* allocated(std::size_t size) {
  void* const memory = g_no_memory ? nullptr : std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocated(size); }
void* operator new[](std::size_t size) { return allocated(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace hgrid {
namespace test {
namespace {

constexpr const char* kWhere = "a_callback_with_a_long_name.failed";  // too long for a std::string without allocation

TEST(Guarded, ReturnsNothingWhereNothingIsThrown) {
  Ledger ledger;
  EXPECT_FALSE(guarded(ledger, kWhere, [] {}));
  EXPECT_TRUE(ledger.counters().empty());
}

TEST(Guarded, CountsAndReturnsWhatIsThrownOfEveryType) {
  Ledger ledger;
  const auto code = [&](auto&& function) { return guarded(ledger, kWhere, function).value().code(); };
  EXPECT_EQ(code([] { throw Refusal(Code::bad_id, "no name"); }), Code::bad_id);
  EXPECT_EQ(code([] { throw std::bad_alloc(); }), Code::limit);
  EXPECT_EQ(code([] { throw std::runtime_error("a fault"); }), Code::internal);
  EXPECT_EQ(code([] { throw 1; }), Code::internal);
  const std::map<std::string, std::uint64_t> expected{{std::string(kWhere) + ".BAD_ID", 1},
                                                      {std::string(kWhere) + ".LIMIT", 1},
                                                      {std::string(kWhere) + ".INTERNAL", 2}};
  EXPECT_EQ(ledger.counters(), expected);
  EXPECT_STREQ(guarded(ledger, kWhere, [] { throw std::runtime_error("a fault"); })->what(), "a fault");
}

TEST(Guarded, StillCountsWhereThereIsNoMemoryForAReport) {
  Ledger ledger;
  for (int i = 0; i < 3; ++i) {
    const std::optional<Refusal> fault = guarded(ledger, kWhere, [] {
      g_no_memory = true;
      const std::vector<int> too_much(1000);
    });
    g_no_memory = false;
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->code(), Code::limit);
  }
  EXPECT_EQ(ledger.counters().at("unreported"), 3u);
  ledger.clear();
  EXPECT_EQ(ledger.counters().count("unreported"), 0u);
}

/// An empty world and its queue of jobs. Each job appends its name to `done`.
struct JobsOfTick {
  Params params;
  Ledger ledger;
  World world{settingsOf(params), false, 1, ledger, makeCoreNarrowPhase()};
  TickJobs jobs;
  std::string done;

  void add(char name) {
    jobs.add(std::string(1, name), [this, name](World&) { done += name; });
  }
  void tick() { jobs.doAll(world, ledger); }
};

TEST(TickJobs, AreDoneOnceInTheirOrder) {
  JobsOfTick t;
  t.add('a');
  t.add('b');
  t.tick();
  t.tick();
  t.add('c');
  t.tick();
  EXPECT_EQ(t.done, "abc");
}

TEST(TickJobs, ThatThrowAreRetriedAndDoNotAffectOthers) {
  JobsOfTick t;
  int failures_left = 2;
  t.add('a');
  t.jobs.add("x", [&](World&) {
    if (failures_left-- > 0) throw std::runtime_error("a fault of a job");
    t.done += 'x';
  });
  t.add('b');
  t.tick();
  EXPECT_EQ(t.done, "ab");
  t.add('c');
  t.tick();
  EXPECT_EQ(t.done, "abc");
  t.tick();
  t.tick();
  EXPECT_EQ(t.done, "abcx");
  EXPECT_EQ(t.ledger.counters().at("job.failed.INTERNAL"), 2u);
}

TEST(TickJobs, MayAddJobsForTheNextTick) {
  JobsOfTick t;
  t.jobs.add("a", [&](World&) { t.add('b'); });
  t.tick();
  EXPECT_EQ(t.done, "");
  t.tick();
  EXPECT_EQ(t.done, "b");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
