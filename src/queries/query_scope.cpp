// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/queries/query_scope.h"

#include <algorithm>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

/// Returns whether QueryScope::respect_allowed excludes `body`. It excludes the body that it names, and all bodies
/// whose pair with the named body is switched off.
bool isAllowed(const Snapshot& snapshot, const QueryScope& scope, std::uint32_t body) {
  return scope.respect_allowed != Structure::kNone && snapshot.structure().filter.allowed(scope.respect_allowed, body);
}

}  // namespace

bool inScope(const Snapshot& snapshot, const QueryScope& scope, std::uint32_t body) {
  if (isAllowed(snapshot, scope, body)) return false;
  const std::string& name = snapshot.structure().bodies[body].name;
  return (scope.include.empty() || matchesAny(scope.include, name)) && !matchesAny(scope.exclude, name);
}

bool inScope(const Snapshot& snapshot, const QueryScope& scope, const SourceGap& gap) {
  const std::uint32_t body = snapshot.structure().find(gap.bodies);
  if (body != Structure::kNone && isAllowed(snapshot, scope, body)) return false;
  const auto included = [&](const std::string& glob) { return canMatchTogether(glob, gap.bodies); };
  const auto excluded = [&](const std::string& glob) { return coversGlob(glob, gap.bodies); };
  return (scope.include.empty() || std::any_of(scope.include.begin(), scope.include.end(), included)) &&
         std::none_of(scope.exclude.begin(), scope.exclude.end(), excluded);
}

}  // namespace hgrid
