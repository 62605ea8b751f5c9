// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>

#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/refusal.h"
#include "queries/question.h"

namespace hgrid {

void checkQueryPoint(const Eigen::Vector3d& point, const std::string& what) {
  if (!point.allFinite()) throw Refusal(Code::nonfinite, what + " is not finite; every coordinate must be finite");
  checkWithin(point, kQueryReach, what);
}

void checkQueryLength(double length, const std::string& what) {
  if (!std::isfinite(length) || length < 0.0) {
    throw Refusal(Code::bad_geometry, what + " is " + text(length) + " m; it must be finite and not negative");
  }
  if (length > kQueryReach) {
    throw Refusal(Code::out_of_range,
                  what + " is " + text(length) + " m; it must be at most " + text(kQueryReach) + " m");
  }
}

void checkScope(const Snapshot& snapshot, const QueryScope& scope) {
  const std::size_t bodies = snapshot.structure().bodies.size();
  if (scope.respect_allowed == Structure::kNone || scope.respect_allowed < bodies) return;
  throw Refusal(Code::unknown_id, "respect_allowed of the query is " + std::to_string(scope.respect_allowed) +
                                      "; it must be smaller than the number of bodies, " + std::to_string(bodies));
}

}  // namespace hgrid
