// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"

namespace hgrid {

/// Computes the poses of the bodies from the recorded transforms, and compares them with the poses that the node used.
///
/// A pose must be what the transforms say at its own stamp, and no newer transforms may exist that the node left out.
/// A pose is skipped if the record does not reach back to its stamp, or if RecordedFrames calls its chain doubtful.
/// The bodies of clouds are skipped, too.
void auditPoses(const AuditCase& audited, AuditFindings& findings);

}  // namespace hgrid
