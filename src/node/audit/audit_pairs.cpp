// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/audit_pairs.h"

#include <algorithm>
#include <cmath>

#include "node/audit/expected_filter.h"
#include "node/audit/expected_rooms.h"
#include "node/audit/listed_pairs.h"

namespace hgrid {
namespace {

constexpr std::uint64_t kMostComparisons = 20000000;  // most comparisons of one audit; they take about 0.1 s

class PairAudit {
 public:
  PairAudit(const AuditCase& audited, const std::vector<RealBoxes>& boxes, AuditFindings& findings)
      : audited_(audited),
        boxes_(boxes),
        findings_(findings),
        filter_(audited),
        rooms_(audited, boxes, filter_),
        listed_(audited) {
    for (std::uint32_t i = 0; i < boxes.size(); ++i) most_ = std::max(most_, filter_.mostOf(i));
  }

  void compare(std::uint32_t first, std::uint32_t second) {
    ++findings_.pairs;
    const RealBoxes &a = boxes_[first], &b = boxes_[second];
    if (a.empty() || b.empty()) return;
    const bool no_planes = a.planes.empty() && b.planes.empty();
    if (no_planes && a.all.exteriorDistance(b.all) > 2.0 * most_) return;
    const double gap = a.gapTo(b), margin = filter_.marginOf(first, second);
    if (gap > margin - kPoseSlack || listed_.find(first, second) != nullptr) return;
    if (audited_.truncated || !filter_.reports(first, second) || !rooms_.surelyJoined(first, second)) return;
    findings_.add(listed_.nameOf(first, second) + " is missing: the gap of its boxes is " + text(gap) +
                  " m and its margin " + text(margin) + " m");
  }

  void checkListed() {
    for (const NearPair& pair : audited_.pairs) check(pair);
  }

 private:
  void check(const NearPair& pair) {
    const std::string subject = listed_.nameOf(pair.first, pair.second);
    if (!filter_.reports(pair.first, pair.second)) findings_.add(subject + " is listed, but it is switched off");
    if (rooms_.surelySeparate(pair.first, pair.second))
      findings_.add(subject + " is listed, but its bodies have no room in common");
    const double margin = filter_.marginOf(pair.first, pair.second);
    if (pair.margin < margin - kPoseSlack) {
      findings_.add(subject + " has the margin " + text(pair.margin) + " m; it should be " + text(margin) + " m");
    }
    const RealBoxes &a = boxes_[pair.first], &b = boxes_[pair.second];
    if (a.empty() || b.empty()) return;  // auditCells() checks pairs with maps and clouds
    const double gap = a.gapTo(b), slack = std::max(roundingOf(audited_, a), roundingOf(audited_, b));
    if (std::abs(pair.gap - gap) > slack) {
      findings_.add(subject + " has the gap " + text(pair.gap) + " m; it should be " + text(gap) + " m");
    } else if (pair.flags == 0 && gap > pair.margin + slack) {
      findings_.add(subject + " is listed, but its gap of " + text(gap) + " m exceeds its margin of " +
                    text(pair.margin) + " m");
    }
  }

  const AuditCase& audited_;
  const std::vector<RealBoxes>& boxes_;
  AuditFindings& findings_;
  const ExpectedFilter filter_;
  ExpectedRooms rooms_;
  const ListedPairs listed_;
  double most_ = 0.0;  // [m] the largest mostOf() of all bodies; no margin of a pair is larger than twice this
};

}  // namespace

void auditPairs(const AuditCase& audited, const std::vector<RealBoxes>& boxes, std::uint64_t seed,
                AuditFindings& findings) {
  PairAudit audit(audited, boxes, findings);
  audit.checkListed();
  const auto bodies = static_cast<std::uint32_t>(boxes.size());
  if (std::uint64_t{bodies} * bodies <= 2 * kMostComparisons) {
    for (std::uint32_t i = 0; i < bodies; ++i) {
      for (std::uint32_t j = i + 1; j < bodies; ++j) audit.compare(i, j);
    }
    return;
  }
  for (std::uint64_t n = 0; n < kMostComparisons / bodies; ++n) {
    const auto i = static_cast<std::uint32_t>((seed + n) % bodies);
    for (std::uint32_t j = 0; j < bodies; ++j) {
      if (j != i) audit.compare(std::min(i, j), std::max(i, j));
    }
  }
}

}  // namespace hgrid
