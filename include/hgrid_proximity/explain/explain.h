// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Says whether a pair of bodies is reported, and everything that decides this. "First" and "second" are the two bodies
/// in the order of the call. Values that are not known are NaN.
struct Explanation {
  std::uint32_t first = 0;                       ///< index of the first body in Structure::bodies
  std::uint32_t second = 0;                      ///< index of the second body in Structure::bodies
  bool reported = false;                         ///< whether Snapshot::pairs() lists the pair
  std::size_t position = 0;                      ///< index in Snapshot::pairs(), if the pair is reported
  bool separate = false;                         ///< whether the two bodies have no room in common (BodyRooms)
  bool cut = false;                              ///< whether the pair is within its margin, but truncation removed it
  std::string text;                              ///< the explanation in sentences, for users
  PairRule rule;                                 ///< the rule that decides about the pair; Origin::none: no rule
  double gap = 0.0;                              ///< [m] distance of the boxes of the two bodies
  double margin = 0.0;                           ///< [m] margin of the pair in this snapshot, including the growth
  double growth = 0.0;                           ///< [m] part of the margin that was added because data is old
  double margin_pair = 0.0;                      ///< [m] margin configured for this pair; NaN if there is none
  double margin_first = 0.0;                     ///< [m] margin of the first body, at least the global margin
  double margin_second = 0.0;                    ///< [m] margin of the second body, at least the global margin
  double age_first = 0.0;                        ///< [s] age of the pose of the first body when the snapshot was made
  double age_second = 0.0;                       ///< [s] age of the pose of the second body when the snapshot was made
  Freshness state_first = Freshness::unplaced;   ///< state of the first body
  Freshness state_second = Freshness::unplaced;  ///< state of the second body
  Measure measured = Measure::not_measured;      ///< result of measuring the exact distance
  double distance = 0.0;                         ///< [m] exact distance; NaN if it was not measured
  Time since{0};                                 ///< NearPair::since, if the pair is reported
};

/// The names of settings in the sentences of explain(). A program with its own settings passes their names.
struct OptionNames {
  const char* max_pairs = "SceneOptions::max_pairs";          ///< largest number of pairs that a snapshot lists
  const char* horizon = "SceneOptions::horizon";              ///< how far a snapshot looks ahead
  const char* pair_kinds = "SceneOptions::pair_kinds";        ///< which kinds of pair exist
  const char* allowed_pairs = "SceneOptions::allowed_pairs";  ///< where rules of Origin::parameter come from
  const char* added_rules = "Scene::setRules()";              ///< where rules of Origin::service come from
  const char* rooms = "SceneOptions::building";               ///< rooms with solid walls
};

/// Explains why a pair of bodies is reported or not.
/// @param first   name of one body
/// @param second  name of the other body
/// @param exact  the measured distance of this pair, in either order of its bodies; null if it was not measured
/// @throws Refusal unknown_id if there is no body of this name; the sentence lists the most similar names
Explanation explain(const Snapshot& snapshot, const std::string& first, const std::string& second,
                    const PairDistance* exact, const OptionNames& options = {});

}  // namespace hgrid
