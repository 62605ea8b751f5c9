// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

class NarrowPhase;

/// Selects the bodies of a query, how exactly the query measures them, and how many hits it returns.
struct QueryScope {
  std::vector<std::string> include;  ///< globs over body names; only matching bodies count; empty: all bodies
  std::vector<std::string> exclude;  ///< globs over body names; matching bodies are left out
  std::uint32_t limit = 0;           ///< maximum number of hits in the answer; 0: all
  /// Makes the query exact: measures the shapes of bodies. Null: the query measures their boxes instead. A shape that
  /// cannot be measured counts as hit if its box is hit. Not owned; must outlive the query.
  const NarrowPhase* exact = nullptr;
  /// Index of a body, or Structure::kNone. The query leaves out this body, and every body whose pair with it is
  /// switched off by the pair filter: they are neither hits nor reasons for UNKNOWN.
  std::uint32_t respect_allowed = Structure::kNone;
  /// When the query stops. It then returns the hits found so far. Without a hit, the verdict is unknown
  /// (Unknown::budget). A query that is measuring a shape at this time first completes the shape. Nullopt: no deadline.
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
};

/// Returns whether a body is in the scope of a query.
bool inScope(const Snapshot& snapshot, const QueryScope& scope, std::uint32_t body);
/// Returns whether a missing body of a source gap may be in the scope of a query.
bool inScope(const Snapshot& snapshot, const QueryScope& scope, const SourceGap& gap);

}  // namespace hgrid
