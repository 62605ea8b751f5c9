// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/query_services.h"

#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/UnknownReason.h>
#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/bodies/name.h"
#include "node/messages/snapshot_stamp.h"
#include "node/services/guarded.h"
#include "node/tf/frames.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostPatterns = 256, kLongestPattern = 512;  // bytes

Eigen::Vector3d fromPoint(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

msg::Hit toMsg(const QueryHit& source, const Snapshot& snapshot, const Pose& frame_from_world, double age_since) {
  msg::Hit hit;
  hit.name = snapshot.structure().bodies[source.body].name;
  hit.shape = source.shape;
  hit.cell_edge = source.cell_edge;
  hit.status = static_cast<std::uint8_t>(source.status);
  hit.distance = source.distance;
  hit.center_distance = source.center_distance;
  hit.along = source.along;
  hit.point = toPoint(frame_from_world * source.point);
  hit.own_point = toPoint(frame_from_world * source.own_point);
  hit.normal = toVector(frame_from_world.linear() * source.normal);
  const BodyPose& pose = snapshot.poses()[source.body];
  hit.state = static_cast<std::uint8_t>(pose.state);
  const bool fixed = snapshot.structure().bodies[source.body].mobility == Mobility::fixed;
  hit.age = fixed ? 0.0 : pose.age + age_since;
  return hit;
}

/// What a CLEAR in a world that is not complete owes its reader.
std::string elsewhere(const Snapshot& snapshot) {
  if (snapshot.complete()) return "";
  const std::vector<std::string>& sources = snapshot.incompleteSources();
  const std::string others = sources.size() > 1 ? " and " + std::to_string(sources.size() - 1) + " more" : "";
  return " ('" + sources.front() + "'" + others + " not complete, but not asked about or not able to be there)";
}

std::string summaryOf(const QueryAnswer& found, const Snapshot& snapshot) {
  if (found.verdict == Verdict::clear) return "CLEAR: nothing is there" + elsewhere(snapshot);
  if (found.verdict == Verdict::unknown) return "UNKNOWN: " + found.reason;
  const std::string first =
      found.hits.empty() ? "" : ", first " + snapshot.structure().bodies[found.hits.front().body].name;
  return "HIT: " + std::to_string(found.total) + (found.total == 1 ? " body" : " bodies") + first;
}

}  // namespace

QueryServices::QueryServices(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash, NewestTick newest,
                             const TransformLookup& transforms, std::shared_ptr<const NarrowPhase> narrow_phase,
                             QuerySketch& sketch, Ledger& ledger)
    : params_(params),
      config_hash_(config_hash),
      newest_(std::move(newest)),
      transforms_(transforms),
      narrow_phase_(std::move(narrow_phase)),
      sketch_(sketch),
      ledger_(ledger) {
  servers_.push_back(advertiseGuarded(node, "query_sphere", &QueryServices::onSphere, this, ledger_));
  servers_.push_back(advertiseGuarded(node, "query_segment", &QueryServices::onSegment, this, ledger_));
  servers_.push_back(advertiseGuarded(node, "query_box", &QueryServices::onBox, this, ledger_));
  servers_.push_back(advertiseGuarded(node, "query_nearest", &QueryServices::onNearest, this, ledger_));
}

Pose QueryServices::worldFromFrame(const Tick& tick, const std::string& frame) const {
  if (frame.empty() || frame == tick.world_frame) return Pose::Identity();
  // The frame may be published at another rate than the robot: its newest pose will do while a body's would be fresh.
  return transforms_.atOrNewest(tick.world_frame, frame, tick.snapshot->stamp(), params_.stale_after,
                                "the query's frame '" + printable(frame) + "'");
}

QueryScope QueryServices::scopeOf(const std::vector<std::string>& include, const std::vector<std::string>& exclude,
                                  std::uint32_t limit) const {
  for (const auto* patterns : {&include, &exclude}) {
    if (patterns->size() > kMostPatterns) {
      throw Refusal(Code::limit, "the query has " + std::to_string(patterns->size()) + " name patterns; at most " +
                                     std::to_string(kMostPatterns) + " are allowed");
    }
    for (const std::string& pattern : *patterns) {
      if (pattern.size() > kLongestPattern) {
        throw Refusal(Code::bad_id, "name pattern '" + printable(pattern, 48) + "' has " +
                                        std::to_string(pattern.size()) + " bytes; at most " +
                                        std::to_string(kLongestPattern) + " are allowed");
      }
    }
  }
  const auto most = static_cast<std::uint32_t>(params_.max_hits);
  return {include, exclude, limit == 0 ? most : std::min(limit, most)};
}

namespace {

/// How many bodies a query is about. A misspelt name must not read as CLEAR.
/// @throws Refusal unknown_id if a pattern to be included can match no body, or none is left
std::size_t asked(const QueryScope& scope, const Snapshot& snapshot) {
  const std::vector<Body>& bodies = snapshot.structure().bodies;
  const std::vector<SourceGap>& gaps = snapshot.gaps();
  for (const std::string& pattern : scope.include) {
    const bool known =
        std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) { return matches(pattern, body.name); });
    const bool awaited = std::any_of(gaps.begin(), gaps.end(),
                                     [&](const SourceGap& gap) { return canMatchTogether(pattern, gap.bodies); });
    if (!known && !awaited) throw Refusal(Code::unknown_id, "no body matches '" + printable(pattern) + "' of include");
  }
  std::size_t count = 0;
  for (std::uint32_t body = 0; body < bodies.size(); ++body) count += inScope(snapshot, scope, body) ? 1 : 0;
  const bool awaits =
      std::any_of(gaps.begin(), gaps.end(), [&](const SourceGap& gap) { return inScope(snapshot, scope, gap); });
  if (count == 0 && !awaits) throw Refusal(Code::unknown_id, "exclude leaves no body to ask for");
  return count;
}

}  // namespace

template <class Request, class Response, class Ask>
bool QueryServices::answer(const Checked<Request>& checked, Response& response, Ask&& ask) {
  const std::shared_ptr<const Tick> tick = newest_();
  msg::Answer& result = response.answer;
  ledger_.count("query.asked");
  try {
    if (!tick) {
      response.world.worst_state = msg::BodyState::UNPLACED;
      throw Refusal(Code::not_ready, "there is no world yet: the first tick was not made");
    }
    const double age_since =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - tick->made.steady).count();
    response.header = headerOf(*tick);
    response.world = worldState(*tick, params_, config_hash_, age_since);
    const Request& request = checked.value();
    if (!tick->snapshot) throw Refusal(Code::not_ready, "there is no world yet: " + tick->not_ready.front());
    const Snapshot& snapshot = *tick->snapshot;
    const std::string frame = withoutSlash(request.header.frame_id);
    checkStamp(request.header.stamp, snapshot);
    const Pose world_from_frame = worldFromFrame(*tick, frame);
    QueryScope scope = scopeOf(request.include, request.exclude, request.limit);
    if (request.exact) scope.exact = narrow_phase_.get();
    const bool all = scope.include.empty() && scope.exclude.empty();
    const std::size_t count = all ? 0 : asked(scope, snapshot);
    QueryAnswer found = ask(request, snapshot, world_from_frame, scope);
    if (found.verdict == Verdict::clear && age_since > params_.valid_for) {
      found.verdict = Verdict::unknown;
      found.because = Unknown::outdated;
      found.reason = "the newest tick is " + secondsText(age_since) + " old; ticks are valid for " +
                     text(params_.valid_for) + " s (~valid_for)";
    }
    const Pose frame_from_world = world_from_frame.inverse();
    if (!frame.empty()) response.header.frame_id = frame;
    for (const QueryHit& hit : found.hits) result.hits.push_back(toMsg(hit, snapshot, frame_from_world, age_since));
    result.success = true;
    result.code = toMsg(Code::ok, found.reason);
    result.verdict = static_cast<std::uint8_t>(found.verdict);
    result.unknown_because = static_cast<std::uint8_t>(found.because);
    result.summary = summaryOf(found, snapshot);
    if (!all && found.verdict == Verdict::clear) {
      result.summary =
          "CLEAR: none of the " + std::to_string(count) + " bodies asked for is there" + elsewhere(snapshot);
    }
    result.total = static_cast<std::uint32_t>(found.total);
    result.truncated = found.total > found.hits.size();
  } catch (const Refusal& refusal) {
    result = msg::Answer();
    result.code = toMsg(refusal.code(), refusal.what());
    result.unknown_because = msg::UnknownReason::REFUSED;
    result.summary = std::string("refused, so UNKNOWN: ") + refusal.what();
    ledger_.refuse("query.refused", refusal);
  } catch (...) {  // a fault of the node's own: the caller hears of it, the node goes on
    const Refusal fault = ledger_.fault("query.failed");
    result = msg::Answer();
    result.code = toMsg(fault.code(), fault.what());
    result.unknown_because = msg::UnknownReason::REFUSED;
  }
  return true;
}

bool QueryServices::onSphere(Checked<msg::QuerySphere::Request>& checked, msg::QuerySphere::Response& response) {
  return answer(
      checked, response,
      [&](const auto& request, const Snapshot& snapshot, const Pose& world_from_frame, const QueryScope& scope) {
        const Sphere sphere{world_from_frame * fromPoint(request.center), request.radius};
        QueryAnswer found = query(snapshot, sphere, scope);
        sketch_.show(sphere, found.verdict);
        return found;
      });
}

bool QueryServices::onSegment(Checked<msg::QuerySegment::Request>& checked, msg::QuerySegment::Response& response) {
  return answer(
      checked, response,
      [&](const auto& request, const Snapshot& snapshot, const Pose& world_from_frame, const QueryScope& scope) {
        const Segment segment{world_from_frame * fromPoint(request.start), world_from_frame * fromPoint(request.end),
                              request.radius};
        QueryAnswer found = query(snapshot, segment, scope);
        sketch_.show(segment, found.verdict);
        return found;
      });
}

bool QueryServices::onBox(Checked<msg::QueryBox::Request>& checked, msg::QueryBox::Response& response) {
  return answer(
      checked, response,
      [&](const auto& request, const Snapshot& snapshot, const Pose& world_from_frame, const QueryScope& scope) {
        const auto& q = request.pose.orientation;
        const bool unset = q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;  // as typed by hand
        const Pose frame_from_box = checkedPose(
            fromPoint(request.pose.position),
            unset ? Eigen::Vector4d(0.0, 0.0, 0.0, 1.0) : Eigen::Vector4d(q.x, q.y, q.z, q.w), "the query's box");
        const Eigen::Vector3d size(request.size.x, request.size.y, request.size.z);
        return query(snapshot, QueryBox{world_from_frame * frame_from_box, size}, *narrow_phase_, scope);
      });
}

bool QueryServices::onNearest(Checked<msg::QueryNearest::Request>& checked, msg::QueryNearest::Response& response) {
  return answer(
      checked, response,
      [&](const auto& request, const Snapshot& snapshot, const Pose& world_from_frame, const QueryScope& given) {
        QueryScope scope = given;
        if (request.limit == 0) scope.limit = 1;
        if (request.body.empty()) {
          return nearest(snapshot, world_from_frame * fromPoint(request.point), request.max_distance, scope);
        }
        const std::uint32_t body = snapshot.structure().find(request.body);
        if (body == Structure::kNone) {
          throw Refusal(Code::unknown_id, "there is no body '" + printable(request.body) + "'");
        }
        return nearest(snapshot, body, request.max_distance, scope);
      });
}

}  // namespace hgrid
