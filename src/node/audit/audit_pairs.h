// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"
#include "node/audit/real_boxes.h"

namespace hgrid {

/// Compares all bodies with all others, and then compares the near pairs with those that the node published. Uses the
/// poses of the node, which auditPoses() checks, but neither its grid nor its filter.
/// @param boxes  the boxes of the bodies, in the order of the bodies; empty for bodies without a pose
/// @param seed   in a world with too many pairs, decides which bodies are compared with all others
void auditPairs(const AuditCase& audited, const std::vector<RealBoxes>& boxes, std::uint64_t seed,
                AuditFindings& findings);

/// Compares bodies with all cells of all maps and clouds. A body with the center of a box within the margin of a cell
/// must be a pair with the map. No body may be a pair with a map if all cells are farther away than the margin.
void auditCells(const AuditCase& audited, const std::vector<RealBoxes>& boxes, std::uint64_t seed,
                AuditFindings& findings);

}  // namespace hgrid
