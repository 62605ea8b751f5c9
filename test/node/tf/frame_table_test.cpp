// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/frame_table.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

constexpr std::uint32_t kNone = FrameTable::kNone;

std::uint32_t put(FrameTable& table, const std::string& parent, const std::string& child) {
  const std::uint32_t frame = table.admit(parent, child);
  table.setParent(frame, parent);
  return frame;
}

TEST(FrameTable, NumbersFramesInTheOrderInWhichTheyOccur) {
  FrameTable table(10);
  EXPECT_EQ(table.find("arm"), kNone);
  const std::uint32_t arm = put(table, "base", "arm"), hand = put(table, "arm", "hand");
  EXPECT_EQ(arm, 0u);
  EXPECT_EQ(table.find("base"), 1u);
  EXPECT_EQ(hand, 2u);
  EXPECT_EQ(put(table, "base", "arm"), arm) << "a frame keeps its number";
  EXPECT_EQ(table.size(), 3u);
  EXPECT_EQ(table.placed(), 2u) << "the base is only a parent";
  EXPECT_FALSE(table.isPlaced(1));
  EXPECT_EQ(table.name(hand), "hand");
}

TEST(FrameTable, KnowsTheNewestParent) {
  FrameTable table(10);
  const std::uint32_t box = table.admit("shelf", "box");
  EXPECT_EQ(table.parent(box), kNone);
  EXPECT_EQ(table.parentName(box), "");
  EXPECT_FALSE(table.isInParent(box, ""));
  table.setParent(box, "shelf");
  table.setParent(box, "gripper");
  EXPECT_EQ(table.parentName(box), "gripper");
  EXPECT_TRUE(table.isInParent(box, "gripper"));
  EXPECT_FALSE(table.isInParent(box, "shelf"));
}

TEST(FrameTable, TellsNamesOfEveryLengthApart) {
  for (const std::size_t length : {1, 40, 41, 42, 200}) {
    FrameTable table(10);
    const std::string name(length, 'a');
    std::string last_differs = name;
    last_differs.back() = 'b';
    const std::uint32_t first = put(table, "base", name), second = put(table, "base", last_differs);
    const std::uint32_t longer = put(table, "base", name + "a");
    for (int repeat = 0; repeat < 2; ++repeat) {  // the second time, each name is the expected one
      EXPECT_EQ(table.again("base", name), first) << length;
      EXPECT_EQ(table.again("base", last_differs), second) << length;
      EXPECT_EQ(table.again("base", name + "a"), longer) << length;
    }
    table.setParent(longer, name);
    EXPECT_EQ(table.again(last_differs, name + "a"), kNone) << length;
    EXPECT_EQ(table.again(name + "b", name + "a"), kNone) << length;
    EXPECT_EQ(table.again(name, name + "a"), longer) << length;
  }
}

TEST(FrameTable, HasAnotherRevisionOnlyIfAFrameOrAParentIsNew) {
  FrameTable table(10);
  put(table, "base", "arm");
  std::uint64_t before = table.revision();
  put(table, "base", "arm");
  EXPECT_EQ(table.revision(), before);
  put(table, "base", "hand");
  EXPECT_GT(table.revision(), before);
  before = table.revision();
  put(table, "arm", "hand");
  EXPECT_GT(table.revision(), before);
}

TEST(FrameTable, RefusesOneFrameMoreThanTheLimitAndGoesOnWithTheOthers) {
  FrameTable table(2);
  put(table, "base", "a");
  put(table, "base", "b");
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { put(table, "base", "c"); }, &sentence), Code::limit);
  EXPECT_EQ(sentence, "transform of frame 'c' would add one frame too many; ~limits/max_frames is 2");
  EXPECT_EQ(table.find("c"), kNone) << "a refused frame gets no number";
  EXPECT_EQ(put(table, "a", "b"), table.find("b"));
  EXPECT_EQ(refusalOf([&] { put(table, "b", "a"); }), Code::limit) << "'b' would be a third parent";
}

TEST(FrameTable, HasRoomForTheFramesThatBodiesNeedAndForThoseAboveThem) {
  FrameTable table(2);
  table.need({"hand"});
  put(table, "junk", "a");
  put(table, "junk", "b");
  EXPECT_EQ(refusalOf([&] { put(table, "junk", "c"); }), Code::limit);
  EXPECT_EQ(refusalOf([&] { put(table, "base", "arm"); }), Code::limit) << "nobody needs this frame yet";
  put(table, "arm", "hand");
  put(table, "base", "arm");  // hand is in it
  EXPECT_EQ(refusalOf([&] { put(table, "map", "base"); }), Code::limit) << "there is room for 2 needed frames";
  EXPECT_EQ(refusalOf([&] { put(table, "junk", "c"); }), Code::limit);
  EXPECT_EQ(table.placed(), 4u);
  table.need({"a", "b"});  // now nobody needs hand and arm
  put(table, "junk", "b");
  EXPECT_EQ(refusalOf([&] { put(table, "arm", "finger"); }), Code::limit) << "hand and arm use the room of the others";
  table.need({"finger"});
  put(table, "arm", "finger");
}

TEST(FrameTable, NeedsTheFramesAboveAPlacedFrameAsSoonAsABodyNeedsIt) {
  FrameTable table(10);
  put(table, "base", "arm");
  put(table, "arm", "hand");
  for (const char* frame : {"base", "arm", "hand"}) EXPECT_FALSE(table.isNeeded(frame)) << frame;
  table.need({"hand"});
  for (const char* frame : {"base", "arm", "hand"}) EXPECT_TRUE(table.isNeeded(frame)) << frame;
  table.need({"arm"});
  EXPECT_FALSE(table.isNeeded("hand"));
  EXPECT_TRUE(table.isNeeded("base"));
}

/// A flood of frames came first. A body that is added later gets its chain, whichever of its frames come first.
TEST(FrameTable, LetsAChainGrowFromEitherEnd) {
  for (const bool downwards : {false, true}) {
    FrameTable table(3);
    for (const char* child : {"a", "b", "c"}) put(table, "junk", child);
    table.need({"hand"});
    const std::vector<std::pair<std::string, std::string>> chain = {{"base", "arm"}, {"arm", "hand"}};
    for (int round = 0; round < 2; ++round) {  // as on /tf, where each transform is sent again
      for (std::size_t i = 0; i < chain.size(); ++i) {
        const auto& link = chain[downwards ? i : chain.size() - 1 - i];
        const bool comes_too_early = downwards && round == 0 && i == 0;
        EXPECT_EQ(refusalOf([&] { put(table, link.first, link.second); }), comes_too_early ? Code::limit : Code::ok);
      }
    }
    EXPECT_EQ(table.parentName(table.find("hand")), "arm");
    EXPECT_EQ(table.parentName(table.find("arm")), "base");
  }
}

/// admit() guesses the next frame from the order of earlier calls. A wrong guess must not change the results.
TEST(FrameTable, FindsFramesInAnyOrder) {
  FrameTable table(100);
  const auto name = [](int i) { return "frame" + std::to_string(i); };
  std::vector<std::uint32_t> numbers;
  for (int i = 0; i < 20; ++i) numbers.push_back(put(table, "base", name(i)));
  for (int step : {1, 3, 7, 19}) {
    for (int i = 0; i < 20; ++i) {
      const int frame = i * step % 20;
      ASSERT_EQ(put(table, "base", name(frame)), numbers[static_cast<std::size_t>(frame)]);
    }
  }
  EXPECT_EQ(table.size(), 21u);
}

/// Claim: of 200,000 frames, the first are stored up to the limit. The others leave nothing behind, and frames that
/// bodies need have room nevertheless.
TEST(FrameTable, KeepsItsLimitInAFloodOf200000Frames) {
  constexpr std::size_t kLimit = 10000, kFrames = 200000;
  FrameTable table(kLimit);
  std::size_t refused = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    if (refusalOf([&] { put(table, "base", "f" + std::to_string(i)); }) == Code::limit) ++refused;
  }
  EXPECT_EQ(refused, kFrames - kLimit);
  EXPECT_EQ(table.placed(), kLimit);
  EXPECT_EQ(table.size(), kLimit + 1) << "the frames and their parent";
  EXPECT_NE(table.find("f9999"), kNone);
  EXPECT_EQ(table.find("f10000"), kNone);
  table.need({"f199999"});
  EXPECT_NE(put(table, "base", "f199999"), kNone);
}

/// Returns 2^14 names that std::hash of libstdc++ for 64 bits maps to the same number. In each group of 16 bytes, both
/// halves of the state of the hash (MurmurHash64A) may flip their highest bit, which cancels out.
std::vector<std::string> collidingNames() {
  constexpr int kGroups = 14;
  constexpr std::uint64_t kFactor = 0xc6a4a7935bd1e995u, kHighest = std::uint64_t{1} << 63;
  std::uint64_t inverse = kFactor;  // of kFactor modulo 2^64, by Newton's method
  for (int i = 0; i < 6; ++i) inverse *= 2 - kFactor * inverse;
  const auto mixed = [&](std::uint64_t k) {
    k *= kFactor, k ^= k >> 47;
    return k * kFactor;
  };
  const auto unmixed = [&](std::uint64_t k) {
    k *= inverse, k ^= k >> 47;
    return k * inverse;
  };
  std::vector<std::string> names;
  for (std::uint32_t bits = 0; bits < 1u << kGroups; ++bits) {
    std::string name;
    for (int group = 0; group < kGroups; ++group) {
      for (const std::uint64_t word : {0x6161616161616161u, 0x6262626262626262u}) {
        const std::uint64_t other = unmixed(mixed(word) ^ kHighest), chosen = bits >> group & 1u ? other : word;
        name.append(reinterpret_cast<const char*>(&chosen), sizeof chosen);
      }
    }
    names.push_back(name);
  }
  return names;
}

/// Claim: names that collide in a hash table are frames like any others.
TEST(FrameTable, KnowsFramesWhoseNamesCollideInAHash) {
  const std::vector<std::string> names = collidingNames();
  const std::hash<std::string> hash;
  if (hash(names.front()) != hash(names.back())) GTEST_SKIP() << "the standard library has another hash";
  FrameTable table(names.size());
  for (const std::string& name : names) put(table, "base", name);
  EXPECT_EQ(table.placed(), names.size());
  for (const std::string& name : names) ASSERT_EQ(table.name(table.find(name)), name);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
