// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

/// Returns the names of the instruction sets that HGrid can use on this processor. The best one is the last.
std::vector<std::string> hgridInstructions();

/// Creates HGrid with this number of threads and with one of the instruction sets of hgridInstructions().
std::unique_ptr<Peer> makeHGrid(int threads, const std::string& instructions);

}  // namespace bench
}  // namespace hgrid
