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

/// Which bodies a query asks about, how exactly it measures them, and how many hits it returns.
struct QueryScope {
  std::vector<std::string> include;  ///< globs over body names; empty: all bodies
  std::vector<std::string> exclude;  ///< globs over body names; a body that they match is left out
  std::uint32_t limit = 0;           ///< most hits that the answer lists; 0: all
  /// Measures the shapes of bodies. Null: a query measures their boxes instead. A shape that has no solid, or that
  /// cannot be measured, counts as hit if its box is hit. Not owned; must outlive the query.
  const NarrowPhase* exact = nullptr;
  /// Index of a body, or Structure::kNone. The query then asks neither about this body nor about any body whose pair
  /// with it is switched off by the snapshot's pair filter: they are no hits and leave no doubt.
  std::uint32_t respect_allowed = Structure::kNone;
  /// When to stop. The query then answers with what it has hit so far. If it has hit nothing, the verdict is unknown
  /// (Unknown::budget). A query may end later by the time that it takes to examine one shape. Nullopt: no deadline.
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
};

/// Whether a query with this scope asks about a body.
bool inScope(const Snapshot& snapshot, const QueryScope& scope, std::uint32_t body);
/// Whether it asks about a body that this gap may hide.
bool inScope(const Snapshot& snapshot, const QueryScope& scope, const SourceGap& gap);

}  // namespace hgrid
