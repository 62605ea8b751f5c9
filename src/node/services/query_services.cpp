// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/query_services.h"

#include <tf2/exceptions.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "node/messages/snapshot_stamp.h"
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

/// What the summary of a CLEAR adds if the world is not complete: which sources are not, although the verdict holds.
std::string elsewhere(const Snapshot& snapshot) {
  if (snapshot.complete()) return "";
  const std::vector<std::string>& sources = snapshot.incompleteSources();
  const std::string others = sources.size() > 1 ? " and " + std::to_string(sources.size() - 1) + " more" : "";
  return " ('" + sources.front() + "'" + others + " not complete, but not asked about or not able to be there)";
}

/// @param asked  number of bodies that the query is about; nullopt: all bodies
std::string summaryOf(const QueryAnswer& found, const Snapshot& snapshot, std::optional<std::size_t> asked) {
  if (found.verdict == Verdict::unknown) return "UNKNOWN: " + found.reason;
  if (found.verdict == Verdict::clear) {
    const std::string none =
        asked ? "none of the " + std::to_string(*asked) + " bodies asked for is there" : "nothing is there";
    return "CLEAR: " + none + elsewhere(snapshot);
  }
  const std::string first =
      found.hits.empty() ? "" : ", first " + snapshot.structure().bodies[found.hits.front().body].name;
  return "HIT: " + std::to_string(found.total) + (found.total == 1 ? " body" : " bodies") + first;
}

void checkPatterns(const std::vector<std::string>& patterns) {
  if (patterns.size() > kMostPatterns) {
    throw Refusal(Code::limit, "the query has " + std::to_string(patterns.size()) + " name patterns; at most " +
                                   std::to_string(kMostPatterns) + " are allowed");
  }
  for (const std::string& pattern : patterns) {
    if (pattern.size() <= kLongestPattern) continue;
    throw Refusal(Code::bad_id, "name pattern '" + printable(pattern, 48) + "' has " + std::to_string(pattern.size()) +
                                    " bytes; at most " + std::to_string(kLongestPattern) + " are allowed");
  }
}

/// Number of bodies that a query is about.
/// @throws Refusal unknown_id if a pattern of include can match no body, or if exclude leaves none: the answer to a
/// misspelled name must not be CLEAR
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
  for (std::uint32_t body = 0; body < bodies.size(); ++body) count += snapshot.inScope(scope, body) ? 1 : 0;
  const bool awaits =
      std::any_of(gaps.begin(), gaps.end(), [&](const SourceGap& gap) { return snapshot.inScope(scope, gap); });
  if (count == 0 && !awaits) throw Refusal(Code::unknown_id, "exclude leaves no body to ask for");
  return count;
}

}  // namespace

QueryServices::QueryServices(ServiceEnvelope& envelope, const Params& params, const tf2::BufferCore& transforms,
                             std::shared_ptr<const NarrowPhase> narrow_phase, QuerySketch& sketch)
    : params_(params), transforms_(transforms), narrow_phase_(std::move(narrow_phase)) {
  serve<msg::QuerySphere>(envelope, "query_sphere", [&sketch](const auto& request, const Question& question) {
    const Sphere sphere{question.world_from_frame * fromPoint(request.center), request.radius};
    QueryAnswer found = question.snapshot.query(sphere, question.scope);
    sketch.show(sphere, found.verdict);
    return found;
  });
  serve<msg::QuerySegment>(envelope, "query_segment", [&sketch](const auto& request, const Question& question) {
    const Segment segment{question.world_from_frame * fromPoint(request.start),
                          question.world_from_frame * fromPoint(request.end), request.radius};
    QueryAnswer found = question.snapshot.query(segment, question.scope);
    sketch.show(segment, found.verdict);
    return found;
  });
  serve<msg::QueryBox>(envelope, "query_box",
                       [this](const auto& request, const Question& question) { return askBox(request, question); });
  serve<msg::QueryNearest>(envelope, "query_nearest", [this](const auto& request, const Question& question) {
    return askNearest(request, question);
  });
}

template <class Service, class Ask>
void QueryServices::serve(ServiceEnvelope& envelope, const char* name, Ask ask) {
  servers_.push_back(
      envelope.serve<Service>(name, "query", [this, ask](ServiceCall<Service>& call) { answer(call, ask); }));
}

template <class Service, class Ask>
void QueryServices::answer(ServiceCall<Service>& call, const Ask& ask) const {
  const auto& request = call.request;
  const Snapshot& snapshot = call.tick.snapshot();
  const std::string frame = withoutSlash(request.header.frame_id);
  checkStamp(request.header.stamp, snapshot);
  const Pose world_from_frame = worldFromFrame(*call.tick.get(), frame);
  const Question question{snapshot, world_from_frame, scopeOf(request)};
  std::optional<std::size_t> count;
  if (!request.include.empty() || !request.exclude.empty()) count = asked(question.scope, snapshot);

  QueryAnswer found = ask(request, question);
  outdate(found, call.tick.age());
  if (!frame.empty()) call.response.header.frame_id = frame;
  msg::Answer& result = call.response.answer;
  const Pose frame_from_world = world_from_frame.inverse();
  for (const QueryHit& hit : found.hits) {
    result.hits.push_back(toMsg(hit, snapshot, frame_from_world, call.tick.age()));
  }
  result.code = toMsg(Code::ok, found.reason);
  result.verdict = static_cast<std::uint8_t>(found.verdict);
  result.unknown_because = static_cast<std::uint8_t>(found.because);
  result.summary = summaryOf(found, snapshot, count);
  result.total = static_cast<std::uint32_t>(found.total);
  result.truncated = found.total > found.hits.size();
}

/// What all kinds of query say about the bodies they ask for and about how they are to be answered.
template <class Request>
QueryScope QueryServices::scopeOf(const Request& request) const {
  checkPatterns(request.include);
  checkPatterns(request.exclude);
  const auto most = static_cast<std::uint32_t>(params_.max_hits);
  QueryScope scope{request.include, request.exclude, request.limit == 0 ? most : std::min(request.limit, most)};
  if (request.exact) scope.exact = narrow_phase_.get();
  return scope;
}

/// The transform of the frame at the time of the tick. If tf does not have that, because the frame is published at
/// another rate than the robot: the newest one, if a body of that age would still be fresh.
geometry_msgs::TransformStamped QueryServices::lookUp(const Tick& tick, const std::string& frame) const {
  const ros::Time stamp = toRos(tick.snapshot->stamp());
  try {
    return transforms_.lookupTransform(tick.world_frame, frame, stamp);
  } catch (const tf2::ExtrapolationException&) {
    const geometry_msgs::TransformStamped newest = transforms_.lookupTransform(tick.world_frame, frame, ros::Time(0));
    const double apart = std::abs((newest.header.stamp - stamp).toSec());
    if (newest.header.stamp.isZero() || apart <= params_.stale_after) return newest;
    throw Refusal(Code::extrapolation, "the query's frame '" + printable(frame) + "' is known at " +
                                           text(newest.header.stamp.toSec()) + " s, the world at " +
                                           text(stamp.toSec()) + " s; they may be " + text(params_.stale_after) +
                                           " s apart (~stale_after)");
  }
}

Pose QueryServices::worldFromFrame(const Tick& tick, const std::string& frame) const {
  if (frame.empty() || frame == tick.world_frame) return Pose::Identity();
  geometry_msgs::TransformStamped transform;
  try {
    transform = lookUp(tick, frame);
  } catch (const tf2::TransformException& error) {
    throw Refusal(Code::unknown_frame, "the query's frame '" + printable(frame) + "' is not connected to '" +
                                           tick.world_frame + "': " + printable(error.what(), 300));
  }
  const auto& t = transform.transform.translation;
  const auto& q = transform.transform.rotation;
  return checkedPose({t.x, t.y, t.z}, {q.x, q.y, q.z, q.w}, "the query's frame '" + printable(frame) + "'");
}

/// Turns CLEAR into UNKNOWN if the tick is too old.
void QueryServices::outdate(QueryAnswer& found, double age) const {
  if (found.verdict != Verdict::clear || age <= params_.valid_for) return;
  found.verdict = Verdict::unknown;
  found.because = Unknown::outdated;
  found.reason = "the newest tick is " + secondsText(age) + " old; ticks are valid for " + text(params_.valid_for) +
                 " s (~valid_for)";
}

QueryAnswer QueryServices::askBox(const msg::QueryBox::Request& request, const Question& question) const {
  const auto& q = request.pose.orientation;
  const bool unset = q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0;  // as in a request typed by hand
  const Eigen::Vector4d rotation = unset ? Eigen::Vector4d(0.0, 0.0, 0.0, 1.0) : Eigen::Vector4d(q.x, q.y, q.z, q.w);
  const Pose frame_from_box = checkedPose(fromPoint(request.pose.position), rotation, "the query's box");
  const Eigen::Vector3d size(request.size.x, request.size.y, request.size.z);
  return question.snapshot.query(QueryBox{question.world_from_frame * frame_from_box, size}, *narrow_phase_,
                                 question.scope);
}

QueryAnswer QueryServices::askNearest(const msg::QueryNearest::Request& request, const Question& question) const {
  QueryScope scope = question.scope;
  if (request.limit == 0) scope.limit = 1;
  if (request.body.empty()) {
    return question.snapshot.nearest(question.world_from_frame * fromPoint(request.point), request.max_distance, scope);
  }
  const std::uint32_t body = question.snapshot.structure().find(request.body);
  if (body == Structure::kNone) {
    throw Refusal(Code::unknown_id, "there is no body '" + printable(request.body) + "'");
  }
  return question.snapshot.nearest(body, request.max_distance, scope);
}

}  // namespace hgrid
