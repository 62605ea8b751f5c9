// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

/// Instruction sets that HGrid can use on this processor, the best one last.
std::vector<std::string> hgridInstructions();

/// HGrid with so many threads and the named one of hgridInstructions().
std::unique_ptr<Peer> makeHGrid(int threads, const std::string& instructions);

}  // namespace bench
}  // namespace hgrid
