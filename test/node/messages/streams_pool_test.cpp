// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <deque>

#include "src/node/messages/pairs_messages.h"
#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

/// Returns each pair of a message as "first second gap".
std::vector<std::string> saidBy(const msg::Pairs& message) {
  std::vector<std::string> pairs;
  for (std::size_t i = 0; i < message.first.size(); ++i) {
    pairs.push_back(message.names.at(message.first[i]) + " " + message.names.at(message.second[i]) + " " +
                    std::to_string(message.gap.at(i)));
  }
  return pairs;
}

/// Returns each pair of a snapshot as "first second gap".
std::vector<std::string> saidBy(const Snapshot& snapshot) {
  std::vector<std::string> pairs;
  for (const NearPair& pair : snapshot.pairs()) {
    pairs.push_back(snapshot.structure().bodies[pair.first].name + " " + snapshot.structure().bodies[pair.second].name +
                    " " + std::to_string(pair.gap));
  }
  return pairs;
}

/// A message that a subscriber still holds, and a copy that was made when the message arrived.
struct Held {
  boost::shared_ptr<const msg::Pairs> message;
  msg::Pairs copy;
};

TEST(PairsMessages, SayWhatTheSnapshotSaysAndDoNotChangeWhileTheyAreHeld) {
  constexpr std::size_t kMost = 8;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    SceneOptions options;
    options.max_pairs = kMost;
    PairsMessages messages;
    Scene scene(options);
    std::deque<Held> held;
    for (int tick = 1; tick <= 100; ++tick) {
      const std::string name = std::to_string(random.below(seed % 2 == 0 ? 12 : 200));
      BodyId id;
      if (!scene.find("obstacle/" + name, id)) id = scene.add(ball(name));
      scene.place(id, at(random.uniform(-4.0, 4.0)), Time{tick});
      if (random.below(20) == 0) scene.remove(id);

      Tick made;
      made.world_frame = "world";
      if (random.below(20) > 0) made.snapshot = scene.commit(Time{tick}, {});
      msg::WorldState world;
      world.sequence = static_cast<std::uint64_t>(tick);
      const auto message = messages.of(made, world);
      EXPECT_EQ(message->world.sequence, world.sequence);
      const auto expected = made.snapshot ? saidBy(*made.snapshot) : std::vector<std::string>();
      EXPECT_EQ(saidBy(*message), expected);
      EXPECT_TRUE(std::is_sorted(message->names.begin(), message->names.end()));
      EXPECT_EQ(message->total, made.snapshot ? made.snapshot->pairsFound() : 0u);
      EXPECT_EQ(message->truncated, message->total > kMost);
      for (const std::size_t size : {message->second.size(), message->margin.size(), message->since.size(),
                                     message->no_contact_before.size(), message->flags.size(), message->state.size()}) {
        EXPECT_EQ(size, expected.size());
      }
      for (const double bound : message->no_contact_before) EXPECT_TRUE(std::isnan(bound));

      held.push_back({message, *message});
      for (const Held& one : held) {
        EXPECT_EQ(one.message->world.sequence, one.copy.world.sequence);
        EXPECT_EQ(one.message->names, one.copy.names);
        EXPECT_EQ(saidBy(*one.message), saidBy(one.copy));
      }
      while (static_cast<int>(held.size()) > random.below(8)) held.pop_front();
    }
    if (::testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
