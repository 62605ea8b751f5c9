// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"

namespace hgrid {

/// Computes the poses of the bodies from the recorded transforms, and compares them with the poses that the node used.
///
/// A pose must be equal to the pose that follows from the transforms at the stamp of the pose. The node must also have
/// used the newest transforms that it had read. A pose is not compared if the record begins after its stamp, if a frame
/// of its chain is doubtful (see RecordedFrames), if the body is a cloud, or if it is a link whose own frame has no
/// transforms.
void auditPoses(const AuditCase& audited, AuditFindings& findings);

}  // namespace hgrid
