// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/audit_pairs.h"
#include "node/audit/expected_filter.h"
#include "node/audit/listed_pairs.h"

namespace hgrid {
namespace {

constexpr std::uint64_t kMostCompared = 20000000;  // most cells that one audit visits; they take about 0.1 s

class CellAudit {
 public:
  CellAudit(const AuditCase& audited, const std::vector<RealBoxes>& boxes, AuditFindings& findings)
      : audited_(audited), boxes_(boxes), findings_(findings), filter_(audited), listed_(audited) {}

  void compare(const RecordedCells& cells, std::uint32_t body) {
    const RealBoxes& boxes = boxes_[body];
    if (boxes.shapes.empty() || audited_.poses[cells.body].state == Freshness::unplaced) return;
    ++findings_.pairs;
    const Pose map_from_world = audited_.poses[cells.body].world_from_body.inverse();
    const double inside = distanceTo(cells, map_from_world * boxes.shapes.front().center());
    const double around = distanceTo(cells, map_from_world * boxes.all.center()) - 0.5 * boxes.all.diagonal().norm();
    const NearPair* listed = listed_.find(body, cells.body);
    const double margin = filter_.marginOf(body, cells.body), slack = roundingOf(audited_, boxes);
    if (listed == nullptr && !audited_.truncated && inside <= margin - slack && filter_.reports(body, cells.body)) {
      findings_.add(listed_.nameOf(body, cells.body) + " is missing: a cell is " + text(inside) +
                    " m from the center of a box of the body, and the margin is " + text(margin) + " m");
    }
    if (listed != nullptr && listed->flags == 0 && around > listed->margin + slack) {
      findings_.add(listed_.nameOf(body, cells.body) + " is listed, but every cell is at least " + text(around) +
                    " m away, and the margin is " + text(listed->margin) + " m");
    }
  }

 private:
  const AuditCase& audited_;
  const std::vector<RealBoxes>& boxes_;
  AuditFindings& findings_;
  const ExpectedFilter filter_;
  const ListedPairs listed_;
};

}  // namespace

void auditCells(const AuditCase& audited, const std::vector<RealBoxes>& boxes, std::uint64_t seed,
                AuditFindings& findings) {
  if (audited.cells.empty()) return;
  CellAudit audit(audited, boxes, findings);
  std::uint64_t left = kMostCompared;
  for (const RecordedCells& cells : audited.cells) {
    const std::uint64_t cost = 2 * cells.voxels.size();
    for (std::uint64_t n = 0; n < boxes.size() && cost <= left; ++n, left -= cost) {
      audit.compare(cells, static_cast<std::uint32_t>((seed + n) % boxes.size()));
    }
  }
}

}  // namespace hgrid
