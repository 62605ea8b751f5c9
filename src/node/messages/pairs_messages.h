// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Pairs.h>

#include <vector>

#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

/// Builds the messages of ~pairs. It keeps a small pool of messages. When nobody else holds a message of the pool, the
/// message is filled again, and a name that is already in its place is not copied again. Only one thread may use this
/// object.
class PairsMessages {
 public:
  /// Returns the message of ~pairs for a tick.
  boost::shared_ptr<msg::Pairs> of(const Tick& tick, const msg::WorldState& world);

 private:
  struct Pooled {
    boost::shared_ptr<msg::Pairs> message = boost::make_shared<msg::Pairs>();
    std::uint64_t revision = 0;        // Structure::revision of the bodies that `named` refers to
    std::vector<std::uint32_t> named;  // for each name in the message: index of its body in Structure::bodies
  };

  Pooled& unused();
  void fillNames(const Snapshot& snapshot, Pooled& pooled);

  static constexpr std::size_t kMostKept = 4;
  std::vector<Pooled> pool_;
  Pooled extra_;                        // used while slow subscribers still hold every message of the pool
  std::vector<std::uint64_t> in_pair_;  // one bit for each body: whether it is in a pair
  std::vector<std::uint32_t> number_;   // for each body in a pair: its index in the names of the message
};

}  // namespace hgrid
