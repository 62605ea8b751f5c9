// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"
#include "node/audit/real_boxes.h"

namespace hgrid {

/// Answers the queries of the case again, by brute force over all bodies, and compares the answers.
/// @param boxes  as for auditPairs()
void auditQueries(const AuditCase& audited, const std::vector<RealBoxes>& boxes, AuditFindings& findings);

}  // namespace hgrid
