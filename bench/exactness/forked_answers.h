// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/exactness/exactness_peer.h"

namespace hgrid {
namespace bench {

/// Asks a peer about all pairs that it knows, in a child process. A pair for which the peer throws, crashes or searches
/// for more than a few seconds has no answer, and the peer goes on with the next one.
/// @throws std::runtime_error if the system provides no memory or no process
std::vector<ExactnessAnswer> forkedAnswers(const ExactnessPeer& peer, const std::vector<test::Case>& pairs);

}  // namespace bench
}  // namespace hgrid
