// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "hgrid_proximity/queries/state_pair.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// A motion of a robot from one state of a StateBatch to another. All variables change linearly and at the same time.
///
/// An angle without limits takes the shorter way around the circle, unless another joint mimics its joint; this
/// includes the angle of a planar joint. The quaternion of a floating joint turns at constant speed along the shorter
/// way. If both ways are equally short, to 1e-6 rad, the edge is unknown (Unknown::half_turn).
struct StateEdge {
  std::uint32_t from = 0;  ///< index of the state where the edge begins
  std::uint32_t to = 0;    ///< index of the state where it ends
};

/// What StateChecker::checkEdges() looks for.
struct EdgeRequest {
  /// [m] Between EdgeAnswer::free_until and EdgeAnswer::at, no point of the robot travels farther than this.
  /// Exceptions: any_contact, a deadline, and shapes that came too near to each other earlier; then `free_until` is
  /// where that began. Without a later contact, such an edge is unknown (Unknown::tolerance). Smaller values take
  /// longer. Between 1e-6 and 1.
  double tolerance = 1e-3;
  /// Whether the search of an edge ends at any contact. This is faster than finding the first contact. `free_until` may
  /// then be 0.
  bool any_contact = false;
  /// Whether to describe the contact of each edge with the verdict hit (StatePair::contact).
  bool contacts = false;
  /// When the search stops. The edges that are not finished get the verdict unknown (Unknown::budget), or hit if a
  /// contact was found. nullopt: no deadline.
  std::optional<std::chrono::steady_clock::time_point> deadline;
};

/// The answer for one edge.
struct EdgeAnswer {
  /// hit: the robot touches something on the way. clear: it surely touches nothing at any configuration of the edge
  /// (for open meshes see StateChecker::checkEdges()). unknown: neither is known.
  Verdict verdict = Verdict::unknown;
  Unknown because = Unknown::no;    ///< why the verdict is unknown
  Code refused = Code::ok;          ///< why the edge was refused, if `because` is Unknown::refused
  bool beyond_limits = false;       ///< whether a joint is beyond its limits at an end of the edge
  std::uint32_t detail = 0;         ///< for StateChecker::sentenceOf()
  std::uint32_t refused_state = 0;  ///< index of the state that was refused, if `because` is Unknown::refused
  /// Verdict hit: where the first contact is, or any contact with EdgeRequest::any_contact, from 0 at the beginning to
  /// 1 at the end of the edge. NaN otherwise.
  double at = std::numeric_limits<double>::quiet_NaN();
  /// From the beginning to here, the robot surely touches nothing. 1 if the edge is clear.
  double free_until = 0.0;
  std::uint32_t first_pair = 0;  ///< index of the pair of this edge in EdgeAnswers::pairs
  std::uint32_t pairs = 0;       ///< 1 if the edge has a pair, otherwise 0
};

/// The answers to a list of edges.
struct EdgeAnswers {
  std::vector<EdgeAnswer> edges;  ///< one for each edge, in the order of the request
  /// Verdict hit: the two bodies in contact. Unknown::tolerance: two bodies that come too near to each other. Points
  /// and normals are in the world frame, for the configuration at EdgeAnswer::at, or near EdgeAnswer::free_until.
  std::vector<StatePair> pairs;
};

}  // namespace hgrid
