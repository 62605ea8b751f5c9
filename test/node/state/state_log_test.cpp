// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/state/state_log.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hgrid_proximity/refusal.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

using Kind = StateEdit::Kind;

/// A file with random records, and what was stored after each of them.
struct WrittenFile {
  std::string bytes;
  std::vector<std::size_t> ends;   // of the records
  std::vector<StateItems> states;  // after the records

  WrittenFile(unsigned seed, int operations) {
    Random random(seed);
    StateItems items{{"obstacle a", "first\n"}};
    bytes = beginningOf(items);
    note(items);
    for (int i = 0; i < operations; ++i) {
      std::vector<StateEdit> edits;
      for (int count = random.between(1, 3); count > 0; --count) {
        const std::string key = "obstacle " + std::string(1, static_cast<char>('a' + random.between(0, 5)));
        const int what = random.between(0, 9);
        if (what == 0) edits.push_back({Kind::erase_kind, "obstacle ", ""});
        if (what > 0 && what < 4) edits.push_back({Kind::erase, key, ""});
        if (what < 4) continue;
        std::string text = "record 0123\n";  // looks like the begin of a record
        for (int more = random.between(0, 20); more > 0; --more) text += static_cast<char>(random.between(0, 255));
        edits.push_back({Kind::set, key, text});
      }
      bytes += recordOf(edits);
      applyEdits(edits, items);
      note(items);
    }
  }

 private:
  void note(const StateItems& items) {
    ends.push_back(bytes.size());
    states.push_back(items);
  }
};

TEST(StateLog, EveryPrefixOfAFileGivesTheStateAfterItsLastCompleteRecord) {
  const WrittenFile file(1, 200);
  for (std::size_t length = file.ends.front(); length <= file.bytes.size(); ++length) {
    const auto records = std::upper_bound(file.ends.begin(), file.ends.end(), length) - file.ends.begin();
    const StateContent content = readState(file.bytes.substr(0, length));
    ASSERT_EQ(content.records, static_cast<std::size_t>(records)) << length;
    ASSERT_EQ(content.items, file.states[static_cast<std::size_t>(records) - 1]) << length;
    ASSERT_EQ(content.damage, "") << length;
  }
}

TEST(StateLog, AFileWithoutACompleteFirstRecordHasNoContent) {
  const WrittenFile file(2, 0);
  for (std::size_t length = 0; length < file.bytes.size(); ++length) {
    EXPECT_EQ(readState(file.bytes.substr(0, length)).records, 0u) << length;
  }
}

TEST(StateLog, EveryFlippedBitIsNoticed) {
  const WrittenFile file(3, 12);
  for (std::size_t bit = 0; bit < 8 * file.bytes.size(); ++bit) {
    std::string bytes = file.bytes;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    try {
      const StateContent content = readState(bytes);
      ASSERT_NE(content.damage, "") << bit;
      const auto intact = std::upper_bound(file.ends.begin(), file.ends.end(), bit / 8) - file.ends.begin();
      ASSERT_EQ(content.records, static_cast<std::size_t>(intact)) << bit;
    } catch (const Refusal& refusal) {
      ASSERT_EQ(refusal.code(), Code::unsupported) << bit;
    }
  }
}

TEST(StateLog, AMissingPartInTheMiddleIsNoticed) {
  const WrittenFile file(4, 20);
  std::string bytes = file.bytes;
  bytes.erase(file.ends[5] + 10, 30);
  const StateContent content = readState(bytes);
  EXPECT_EQ(content.records, 6u);
  EXPECT_EQ(content.damage, "the record at byte " + std::to_string(file.ends[5]) + " of " +
                                std::to_string(bytes.size()) + " is damaged");
}

TEST(StateLog, AnotherVersionIsRefusedByName) {
  try {
    readState("hgrid_proximity_state 2\nrecord");
    FAIL() << "not refused";
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), Code::unsupported);
    EXPECT_STREQ(refusal.what(),
                 "the file begins with 'hgrid_proximity_state 2'; this version of the node reads only "
                 "'hgrid_proximity_state 1'");
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
