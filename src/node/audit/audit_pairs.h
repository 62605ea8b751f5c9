// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"
#include "node/audit/real_boxes.h"

namespace hgrid {

/// Compares each body with each other body to find the near pairs. Compares these with the pairs that the tick lists.
/// Uses the poses of the node, because auditPoses() checks them. Uses neither the grid nor the pair filter nor the
/// rooms of the node.
/// @param boxes  for each body: its boxes; none if the body has no pose
/// @param seed   if the world has too many pairs, selects the bodies that are compared with all others
void auditPairs(const AuditCase& audited, const std::vector<RealBoxes>& boxes, std::uint64_t seed,
                AuditFindings& findings);

/// Compares bodies with all cells of all maps and clouds. A body and a map must be a pair if a cell is at most the
/// margin away from the center of the body's first box. They must not be a pair if all cells are farther away from the
/// body than the margin.
/// @param boxes  for each body: its boxes; none if the body has no pose
/// @param seed   if there are too many cells, selects the bodies that are compared with them
void auditCells(const AuditCase& audited, const std::vector<RealBoxes>& boxes, std::uint64_t seed,
                AuditFindings& findings);

}  // namespace hgrid
