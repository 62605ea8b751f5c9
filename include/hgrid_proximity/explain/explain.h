// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Whether a pair of bodies is reported, and all that decides it. Of the first body and the second: in the order in
/// which they were asked for. NaN where nothing is known.
struct Explanation {
  std::uint32_t first = 0, second = 0;             ///< indices into Structure::bodies
  bool reported = false;                           ///< stands in Snapshot::pairs()
  std::size_t position = 0;                        ///< where it stands there
  bool cut = false;                                ///< it is within its margin, but truncation removed it
  std::string text;                                ///< a sentence or a few for people
  PairRule rule;                                   ///< what decided; Origin::none: nothing switches the pair off
  double gap = 0.0;                                ///< [m] distance of their boxes
  double margin = 0.0;                             ///< [m] that applies to the pair now, growth included
  double growth = 0.0;                             ///< [m] of margin: since data is stale
  double margin_pair = 0.0;                        ///< [m] that was told for this pair; NaN if there is none
  double margin_first = 0.0, margin_second = 0.0;  ///< [m] of each body, at least the global one
  double age_first = 0.0, age_second = 0.0;        ///< [s] of the poses when the snapshot was made
  Freshness state_first = Freshness::unplaced, state_second = Freshness::unplaced;
  Measure measured = Measure::not_measured;
  double distance = 0.0;  ///< [m] exact
  Time since{0};          ///< of a reported pair, as NearPair::since
};

/// How the sentences of explain() name what a user can set. A program with options of its own gives their names.
struct OptionNames {
  const char* max_pairs = "SceneOptions::max_pairs";
  const char* horizon = "SceneOptions::horizon";
  const char* pair_kinds = "SceneOptions::pair_kinds";
  const char* allowed_pairs = "SceneOptions::allowed_pairs";  ///< rules of Origin::parameter
  const char* added_rules = "Scene::setRules()";              ///< rules of Origin::service
};

/// Explains why a pair of bodies is reported or not.
/// @param exact  what was measured of this pair, in either order of its bodies; null if nothing was measured
/// @throws Refusal unknown_id, naming the bodies with the most similar names
Explanation explain(const Snapshot& snapshot, const std::string& first, const std::string& second,
                    const PairDistance* exact, const OptionNames& options = {});

}  // namespace hgrid
