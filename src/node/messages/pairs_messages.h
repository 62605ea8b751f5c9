// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Pairs.h>

#include <vector>

#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {

/// Makes the messages of ~pairs from a small pool. A message is never altered while somebody beside the pool holds it;
/// then it is filled again, and the names that it has already are not copied anew. One thread.
class PairsMessages {
 public:
  boost::shared_ptr<msg::Pairs> of(const Tick& tick, const msg::WorldState& world);

 private:
  struct Pooled {
    boost::shared_ptr<msg::Pairs> message = boost::make_shared<msg::Pairs>();
    std::uint64_t revision = 0;        // of the bodies whose names it has
    std::vector<std::uint32_t> named;  // index of the body of every name
  };

  Pooled& unused();
  void fillNames(const Snapshot& snapshot, Pooled& pooled);

  static constexpr std::size_t kMostKept = 4;
  std::vector<Pooled> pool_;
  Pooled extra_;                       // all of the pool is held by slow readers
  std::vector<std::uint32_t> number_;  // scratch: number of each body among the names
};

}  // namespace hgrid
