// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"

namespace hgrid {

/// Computes one tick again, from the recorded transforms and the shapes of the bodies. Compares the result with the
/// result of the node. Uses the types of the folders tf, geometry, broadphase, maps, pairs and queries, but none of
/// their algorithms.
/// @param seed  selects the bodies that are compared if the world is too large to compare all of them
AuditFindings audit(const AuditCase& audited, std::uint64_t seed);

}  // namespace hgrid
