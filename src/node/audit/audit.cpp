// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/audit.h"

#include "node/audit/audit_pairs.h"
#include "node/audit/audit_poses.h"
#include "node/audit/audit_queries.h"

namespace hgrid {

AuditFindings audit(const AuditCase& audited, std::uint64_t seed) {
  AuditFindings findings;
  auditPoses(audited, findings);
  std::vector<RealBoxes> boxes(audited.bodies.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const BodyPose& pose = audited.poses[i];
    if (pose.state != Freshness::unplaced) boxes[i] = realBoxesOf(audited.bodies[i], pose.world_from_body);
  }
  auditPairs(audited, boxes, seed, findings);
  auditCells(audited, boxes, seed, findings);
  auditQueries(audited, boxes, findings);
  return findings;
}

}  // namespace hgrid
