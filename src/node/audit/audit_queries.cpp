// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/audit_queries.h"

#include <algorithm>
#include <array>

#include "geometry/infinity.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

using Kind = RecordedQuery::Kind;

/// The least and the largest value [m] that the distance between a body and a query may have.
struct Range {
  double low = kInfinity, high = kInfinity;
};

std::array<Eigen::Vector3d, 9> pointsOf(const OrientedBox& box) {
  std::array<Eigen::Vector3d, 9> points;
  points.fill(box.world_from_box.translation());
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    points[static_cast<std::size_t>(corner)] = box.world_from_box * Eigen::Vector3d(sign.cwiseProduct(box.size));
  }
  return points;
}

/// Returns bounds for the distance between an oriented box and the boxes of a body. The upper bound is the distance of
/// the corners and the center of the oriented box. The lower bound is the distance of the sphere around it.
Range rangeOf(const OrientedBox& box, const RealBoxes& boxes) {
  Range range;
  for (const Eigen::Vector3d& point : pointsOf(box)) range.high = std::min(range.high, boxes.distanceTo(point));
  range.low = std::max(0.0, boxes.distanceTo(box.world_from_box.translation()) - 0.5 * box.size.norm());
  return range;
}

Range rangeOf(const RecordedQuery& query, const RealBoxes& boxes) {
  double distance = 0.0;
  switch (query.kind) {
    case Kind::sphere:
      distance = std::max(0.0, boxes.distanceTo(query.from) - query.radius);
      break;
    case Kind::segment:
      distance = std::max(0.0, boxes.distanceTo(query.from, query.to) - query.radius);
      break;
    case Kind::box:
      return rangeOf(query.box, boxes);
    case Kind::nearest:
      distance = boxes.distanceTo(query.from);
      break;
  }
  return {distance, distance};
}

const char* nameOf(Kind kind) {
  constexpr const char* kNames[] = {"sphere", "segment", "box", "nearest"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// Compares the answer to one query.
class QueryAudit {
 public:
  QueryAudit(const AuditCase& audited, const RecordedQuery& query, const std::vector<RealBoxes>& boxes,
             AuditFindings& findings)
      : audited_(audited), query_(query), boxes_(boxes), findings_(findings) {}

  void run() {
    ++findings_.queries;
    if ((query_.verdict == Verdict::hit) != !query_.hits.empty()) add("its verdict does not fit its hits");
    for (const RecordedQuery::Hit& hit : query_.hits) checkHit(hit);
    if (query_.kind == Kind::nearest) return checkNearest();
    for (std::uint32_t body = 0; body < boxes_.size(); ++body) checkMissing(body);
    if (query_.kind == Kind::sphere) checkCells();
  }

 private:
  void checkHit(const RecordedQuery::Hit& hit) {
    if (boxes_[hit.body].empty()) return;  // a map or a cloud
    const Range range = rangeOf(query_, boxes_[hit.body]);
    const double slack = roundingOf(audited_, boxes_[hit.body]);
    if (hit.distance < range.low - slack || hit.distance > range.high + slack) {
      add("the distance of '" + nameOfBody(hit.body) + "' is " + text(hit.distance) + " m; it should be " +
          text(range.low) + " .. " + text(range.high) + " m");
    }
    if (query_.kind != Kind::nearest && range.low > slack) {
      add("'" + nameOfBody(hit.body) + "' is a hit, but " + text(range.low) + " m away");
    }
  }

  void checkMissing(std::uint32_t body) {
    if (boxes_[body].empty() || isHit(body)) return;
    const Range range = rangeOf(query_, boxes_[body]);
    if (range.high > 0.0) return;
    if (isInside(body)) add("'" + nameOfBody(body) + "' is no hit, but the query touches its box");
  }

  /// Whether the query also touches the body if its boxes and planes are made smaller by kPoseSlack on each side. If
  /// not, an accepted error of the pose explains why the body is no hit.
  bool isInside(std::uint32_t body) const {
    RealBoxes smaller = boxes_[body];
    for (Eigen::AlignedBox3d& box : smaller.shapes) {
      box.min().array() += kPoseSlack;
      box.max().array() -= kPoseSlack;
    }
    for (auto& plane : smaller.planes) plane.offset() += kPoseSlack;
    const auto is_empty = [](const Eigen::AlignedBox3d& box) { return box.isEmpty(); };
    smaller.shapes.erase(std::remove_if(smaller.shapes.begin(), smaller.shapes.end(), is_empty), smaller.shapes.end());
    return rangeOf(query_, smaller).high <= 0.0;
  }

  void checkNearest() {
    double least = kInfinity;
    for (const RealBoxes& boxes : boxes_) least = std::min(least, rangeOf(query_, boxes).high);
    if (least == kInfinity) return;
    if (query_.hits.empty()) return add("it has no hit, but there are bodies");
    const double slack = kPoseSlack + roundingOf(audited_, boxes_[query_.hits.front().body]);
    if (query_.hits.front().distance > least + slack) {
      add("the distance of the nearest body is " + text(query_.hits.front().distance) + " m; it should be at most " +
          text(least) + " m");
    }
  }

  void checkCells() {
    for (const RecordedCells& cells : audited_.cells) {
      const BodyPose& pose = audited_.poses[cells.body];
      if (pose.state == Freshness::unplaced || isHit(cells.body)) continue;
      const double distance = distanceTo(cells, pose.world_from_body.inverse() * query_.from);
      if (distance <= query_.radius - kPoseSlack) {
        add("'" + nameOfBody(cells.body) + "' is no hit, but a cell is " + text(distance) + " m from the center");
      }
    }
  }

  bool isHit(std::uint32_t body) const {
    return std::any_of(query_.hits.begin(), query_.hits.end(),
                       [&](const RecordedQuery::Hit& hit) { return hit.body == body; });
  }
  std::string nameOfBody(std::uint32_t body) const { return printable(audited_.bodies[body].name); }
  void add(const std::string& sentence) {
    findings_.add(std::string("the answer to a ") + nameOf(query_.kind) + " query at (" + text(query_.from.x()) + ", " +
                  text(query_.from.y()) + ", " + text(query_.from.z()) + ") m is wrong: " + sentence);
  }

  const AuditCase& audited_;
  const RecordedQuery& query_;
  const std::vector<RealBoxes>& boxes_;
  AuditFindings& findings_;
};

}  // namespace

void auditQueries(const AuditCase& audited, const std::vector<RealBoxes>& boxes, AuditFindings& findings) {
  for (const RecordedQuery& query : audited.queries) QueryAudit(audited, query, boxes, findings).run();
}

}  // namespace hgrid
