// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/loading/pending_loads.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

namespace hgrid {
namespace test {
namespace {

/// Tries all loads. Loads in `good` succeed, and the load `fatal` throws.
/// @returns the names of the tried loads in order, and '!' if one threw
std::string tried(PendingLoads<char>& loads, const std::set<char>& good, char fatal = 0) {
  std::string order;
  try {
    loads.tryAll([&](char load) {
      order += load;
      if (load == fatal) throw std::runtime_error("no memory");
      return good.count(load) != 0;
    });
  } catch (const std::runtime_error&) {
    order += '!';
  }
  return order;
}

PendingLoads<char> loadsOf(const std::string& all) {
  PendingLoads<char> loads;
  for (const char load : all) loads.put(std::string(1, load), load);
  return loads;
}

TEST(PendingLoads, AreTriedInOrderUntilEachHasSucceeded) {
  PendingLoads<char> loads = loadsOf("abcd");
  EXPECT_EQ(tried(loads, {'b', 'd'}), "abcd");
  EXPECT_EQ(tried(loads, {}), "ac");
  EXPECT_FALSE(loads.empty());
  EXPECT_EQ(tried(loads, {'a', 'c'}), "ac");
  EXPECT_TRUE(loads.empty());
  EXPECT_EQ(tried(loads, {}), "");
}

TEST(PendingLoads, OfOneNameTheNewestReplacesTheOlder) {
  PendingLoads<char> loads = loadsOf("ab");
  loads.put("a", 'A');
  EXPECT_EQ(tried(loads, {}), "bA");
}

TEST(PendingLoads, AreForgottenByNameOrAllTogether) {
  PendingLoads<char> loads = loadsOf("abc");
  loads.remove("b");
  loads.remove("x");
  EXPECT_EQ(tried(loads, {}), "ac");
  loads.clear();
  EXPECT_TRUE(loads.empty());
}

TEST(PendingLoads, StayFromTheOneThatThrowsOn) {
  PendingLoads<char> loads = loadsOf("abcd");
  EXPECT_EQ(tried(loads, {'a', 'b', 'd'}, 'c'), "abc!");
  EXPECT_EQ(tried(loads, {}), "cd");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
