// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"

namespace hgrid {

/// Compares what the node made of one tick with what follows from the recorded transforms and the shapes. Uses no code
/// of the folders tf, geometry, broadphase, maps, pairs and queries, apart from their types.
/// @param seed  decides what is compared in a world that is too large to compare everything
AuditFindings audit(const AuditCase& audited, std::uint64_t seed);

}  // namespace hgrid
