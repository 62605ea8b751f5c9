// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"
#include "world/horizon.h"

namespace hgrid {

/// Finds the pairs of planes with bodies that have boxes. No box is around a half-space, so the broad phase does not
/// hold planes. This class compares each plane with each box whose body the pair filter pairs with the plane. Fixed
/// bodies are not among them, so they cost no time. Two planes make no pair, and a plane and a map make no pair.
///
/// The class remembers which boxes are near each plane. So a tick costs what moved: it compares only the boxes of the
/// bodies that changed, if they are few and the horizon is 0.
class PlanePairs {
 public:
  /// Receives a pair of bodies, its gap [m] and margin [m], and whether the gap is within the margin.
  using Add = std::function<void(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near)>;
  /// Calls `add` for each plane and box that are near, or that may soon be near (see Horizon). The calls are in the
  /// order of the planes, then of the boxes.
  /// @param changed  all bodies whose poses or states changed since the last find(), or since the last accepted tick
  /// @param most     maximum number of calls of `add`
  /// @returns whether it has reported all pairs
  bool find(const Snapshot& snapshot, const Horizon& horizon, const std::vector<std::uint32_t>& changed,
            std::size_t most, const Add& add);
  /// Returns whether find() with the same snapshot and no limit would report a plane of one of the two bodies with a
  /// box of the other. Call it after find(). Ignores the pair filter.
  bool isNear(const Snapshot& snapshot, const Horizon& horizon, std::uint32_t first, std::uint32_t second) const;
  /// Accepts the tick of the last find(): the next find() compares with its planes. Allocates no memory.
  void accept();

 private:
  struct OfPlane {
    BodyId body;
    std::uint32_t shape = 0;  // index among the shapes of the body
    HalfSpace now, before;    // in the tick of the last find(), and in the last accepted tick
    bool is_placed = false, was_placed = false;
    std::vector<ProxyId> partners;  // the boxes that the filter pairs with the plane, ascending
    std::vector<ProxyId> near;  // the partners that are near enough to be reported, and maybe a few others, ascending
    std::optional<HalfSpace> near_of;  // the half-space that `near` was listed for; empty: `near` is not valid
  };
  /// What find() and isNear() know about a plane and a box.
  struct Meeting {
    double gap, margin;  // [m]
    bool near, soon;     // whether the gap is within the margin; whether the two may meet within the horizon
  };

  void renumber(const Structure& structure);
  static bool isNearby(const OfPlane& plane, std::uint32_t body, ProxyId box, const Snapshot& snapshot,
                       const Horizon& horizon);
  void listNear(OfPlane& plane, std::uint32_t body, const Snapshot& snapshot, const Horizon& horizon,
                const std::vector<std::uint32_t>& changed);
  static Meeting meetingOf(const OfPlane& plane, std::uint32_t body, ProxyId box, const Snapshot& snapshot,
                           const Horizon& horizon);

  std::uint64_t revision_ = 0;
  std::vector<OfPlane> planes_;                // in the order of Structure::planes
  std::vector<ProxyId> compared_, unchanged_;  // buffers of listNear()
};

}  // namespace hgrid
