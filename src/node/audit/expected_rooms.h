// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "node/audit/audit_case.h"
#include "node/audit/expected_filter.h"
#include "node/audit/real_boxes.h"

namespace hgrid {

/// Computes from the rooms and doors of a case which bodies have a room in common (see BodyRooms). Uses no code of the
/// folder broadphase, which the audit checks. The grown boxes of the node are rounded, so some answers are "neither".
class ExpectedRooms {
 public:
  /// @param boxes   for each body: its boxes
  /// @param filter  says how much the boxes are grown; it must outlive this object, as `audited` and `boxes`
  ExpectedRooms(const AuditCase& audited, const std::vector<RealBoxes>& boxes, const ExpectedFilter& filter)
      : audited_(audited), boxes_(boxes), filter_(filter), known_(boxes.size()) {}

  /// Whether the two bodies surely have a room in common, or one of them is surely anywhere.
  bool surelyJoined(std::uint32_t first, std::uint32_t second);
  /// Whether the two bodies surely have no room in common.
  bool surelySeparate(std::uint32_t first, std::uint32_t second);

 private:
  /// The rooms of a body. A flag for each room: it is surely, or possibly, one of them.
  struct Found {
    std::vector<bool> surely, possibly;
    bool surely_anywhere = false, possibly_anywhere = false;
  };
  const Found& of(std::uint32_t body);
  Found look(std::uint32_t body) const;
  bool listRooms(const Eigen::AlignedBox3d& box, double away, double reach, std::vector<bool>& rooms) const;

  const AuditCase& audited_;
  const std::vector<RealBoxes>& boxes_;
  const ExpectedFilter& filter_;
  std::vector<std::optional<Found>> known_;  // for each body: its rooms, if they were asked for
};

}  // namespace hgrid
