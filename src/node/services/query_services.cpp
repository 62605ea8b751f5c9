// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/query_services.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bodies/nearest_names.h"
#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/pair_rule.h"
#include "hgrid_proximity/queries/query.h"
#include "node/messages/from_messages.h"
#include "node/services/request_checks.h"
#include "node/tf/frame_names.h"

namespace hgrid {
namespace {

/// Whether a body is an obstacle that is attached to a link.
bool isCarried(const Structure& structure, const std::string& body) {
  const std::vector<PairRule>& rules = structure.filter.rules();
  return std::any_of(rules.begin(), rules.end(),
                     [&](const PairRule& rule) { return rule.origin == Origin::attached && rule.first == body; });
}

msg::Hit toMsg(const QueryHit& source, const Snapshot& snapshot, const Pose& frame_from_world, double age_since) {
  msg::Hit hit;
  hit.name = snapshot.structure().bodies[source.body].name;
  hit.shape = source.shape;
  hit.cell_edge = source.cell_edge;
  hit.status = static_cast<std::uint8_t>(source.status);
  hit.distance = source.distance;
  hit.signed_distance = source.signed_distance;
  hit.depth = source.depth;
  hit.center_distance = source.center_distance;
  hit.along = source.along;
  hit.point = toPoint(frame_from_world * source.point);
  hit.own_point = toPoint(frame_from_world * source.own_point);
  hit.normal = toVector(frame_from_world.linear() * source.normal);
  const BodyPose& pose = snapshot.poses()[source.body];
  hit.state = static_cast<std::uint8_t>(pose.state);
  const bool fixed = snapshot.structure().bodies[source.body].mobility == Mobility::fixed;
  hit.age = fixed ? 0.0 : pose.age + age_since;
  hit.carried = isCarried(snapshot.structure(), hit.name);
  return hit;
}

/// Returns the end of the summary of a CLEAR answer: it names sources that are not complete but do not affect the
/// verdict. Empty if the world is complete.
std::string elsewhere(const Snapshot& snapshot) {
  if (snapshot.complete()) return "";
  const std::vector<std::string>& sources = snapshot.incompleteSources();
  const std::string others = sources.size() > 1 ? " and " + std::to_string(sources.size() - 1) + " more" : "";
  return " (not complete: '" + sources.front() + "'" + others +
         "; the query does not ask about it or it cannot be there)";
}

/// Returns the summary of an answer.
/// @param asked  number of bodies that the query asks about; nullopt: all bodies
std::string summaryOf(const QueryAnswer& found, const Snapshot& snapshot, std::optional<std::size_t> asked) {
  if (found.verdict == Verdict::unknown) return "UNKNOWN: " + found.reason;
  if (found.verdict == Verdict::clear) {
    const std::string none =
        asked ? "none of the " + std::to_string(*asked) + " requested bodies is there" : "nothing is there";
    return "CLEAR: " + none + elsewhere(snapshot);
  }
  const std::string first =
      found.hits.empty() ? "" : ", first " + snapshot.structure().bodies[found.hits.front().body].name;
  return "HIT: " + std::to_string(found.total) + (found.total == 1 ? " body" : " bodies") + first;
}

/// Returns the index of the body of this name. @throws Refusal unknown_id
std::uint32_t indexOf(const Snapshot& snapshot, const std::string& name) {
  const std::uint32_t body = snapshot.structure().find(name);
  if (body == Structure::kNone) throw Refusal(Code::unknown_id, noSuchBody(name, snapshot.structure().bodies));
  return body;
}

/// Returns the name of the body whose allowed pairs respect_allowed leaves out: as_body. If as_body is empty in a
/// request of query_nearest, this is the body from which the query measures.
template <class Request>
std::string asBody(const Request& request) {
  return request.as_body;
}
std::string asBody(const msg::QueryNearest::Request& request) {
  return request.as_body.empty() ? request.body : request.as_body;
}

/// Returns the number of bodies that a query asks about.
/// @throws Refusal unknown_id if a pattern of include can match no body, or if exclude leaves no body. Otherwise a
/// query with a misspelled name would answer CLEAR.
std::size_t asked(const QueryScope& scope, const Snapshot& snapshot) {
  const BodyList& bodies = snapshot.structure().bodies;
  const std::vector<SourceGap>& gaps = snapshot.gaps();
  for (const std::string& pattern : scope.include) {
    const bool known =
        std::any_of(bodies.begin(), bodies.end(), [&](const Body& body) { return matches(pattern, body.name); });
    const bool awaited = std::any_of(gaps.begin(), gaps.end(),
                                     [&](const SourceGap& gap) { return canMatchTogether(pattern, gap.bodies); });
    if (!known && !awaited) {
      throw Refusal(Code::unknown_id, "no body matches the glob '" + printable(pattern) + "' of include" +
                                          (isGlob(pattern) ? "" : similarNames(pattern, bodies)));
    }
  }
  std::size_t count = 0;
  for (std::uint32_t body = 0; body < bodies.size(); ++body) count += inScope(snapshot, scope, body) ? 1 : 0;
  const bool awaits =
      std::any_of(gaps.begin(), gaps.end(), [&](const SourceGap& gap) { return inScope(snapshot, scope, gap); });
  if (count == 0 && !awaits) throw Refusal(Code::unknown_id, "exclude leaves out all bodies; at least one must remain");
  return count;
}

}  // namespace

QueryServices::QueryServices(ServiceEnvelope& envelope, const Params& params, const TransformLookup& transforms,
                             const TickHistory& history, std::shared_ptr<NarrowPhase> narrow_phase, QuerySketch& sketch)
    : params_(params), transforms_(transforms), history_(history), narrow_phase_(std::move(narrow_phase)) {
  serve<msg::QuerySphere>(envelope, "query_sphere", [&sketch](const auto& request, const Question& question) {
    const Sphere sphere{question.world_from_frame * fromPoint(request.center), request.radius};
    QueryAnswer found = query(question.snapshot, sphere, question.scope);
    sketch.show(sphere, found.verdict);
    return found;
  });
  serve<msg::QuerySegment>(envelope, "query_segment", [&sketch](const auto& request, const Question& question) {
    const Segment segment{question.world_from_frame * fromPoint(request.start),
                          question.world_from_frame * fromPoint(request.end), request.radius};
    QueryAnswer found = query(question.snapshot, segment, question.scope);
    sketch.show(segment, found.verdict);
    return found;
  });
  serve<msg::QueryBox>(envelope, "query_box",
                       [this](const auto& request, const Question& question) { return askBox(request, question); });
  serve<msg::QueryShape>(envelope, "query_shape",
                         [this](const auto& request, const Question& question) { return askShape(request, question); });
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
  call.tick.snapshot();  // throws while there is no world
  const std::shared_ptr<const Tick> newest = call.tick.get();
  call.answerFrom(history_.at(request.header.stamp, newest));
  const Snapshot& snapshot = call.tick.snapshot();
  const std::string frame = withoutSlash(request.header.frame_id);
  const Pose world_from_frame = worldFromFrame(*call.tick.get(), frame);
  std::optional<std::size_t> count;
  checkPatterns(request.include);
  checkPatterns(request.exclude);
  if (!request.include.empty() || !request.exclude.empty()) {
    count = asked(QueryScope{request.include, request.exclude}, snapshot);
  }
  const Question question{snapshot, world_from_frame, scopeOf(request, snapshot)};

  QueryAnswer found = ask(request, question);
  if (!namesItsTime(request.header.stamp)) outdate(found, call.tick);
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
  const std::string ago = agoText(snapshot, *newest->snapshot);
  if (!ago.empty()) result.summary += " (" + ago + ")";
  result.total = static_cast<std::uint32_t>(found.total);
  result.truncated = found.total > found.hits.size();
}

/// Reads the options that all kinds of query have in common: which bodies they ask about, and how to answer.
template <class Request>
QueryScope QueryServices::scopeOf(const Request& request, const Snapshot& snapshot) const {
  const auto most = static_cast<std::uint32_t>(params_.max_hits);
  QueryScope scope{request.include, request.exclude, request.limit == 0 ? most : std::min(request.limit, most)};
  if (request.exact) scope.exact = narrow_phase_.get();
  scope.deadline = deadlineOf(request.max_time);
  if (request.respect_allowed) {
    if (asBody(request).empty()) {
      throw Refusal(
          Code::bad_id,
          "respect_allowed is true but as_body is empty; set as_body to the body whose allowed pairs are to be left "
          "out");
    }
    scope.respect_allowed = indexOf(snapshot, asBody(request));
  }
  return scope;
}

Pose QueryServices::worldFromFrame(const Tick& tick, const std::string& frame) const {
  if (frame.empty() || frame == tick.world_frame) return Pose::Identity();
  // The frame may be published at another rate than the robot. So its newest pose is accepted up to ~stale_after.
  return transforms_.atOrNewest(tick.world_frame, frame, tick.snapshot->stamp(), params_.stale_after,
                                "the query's frame '" + printable(frame) + "'");
}

/// Turns CLEAR into UNKNOWN if the tick is too old.
void QueryServices::outdate(QueryAnswer& found, const AnswerTick& tick) {
  const double age = tick.age(), valid_for = tick.get()->settings->params.valid_for;
  if (found.verdict != Verdict::clear || age <= valid_for) return;
  found.verdict = Verdict::unknown;
  found.because = Unknown::outdated;
  found.reason =
      "the newest tick is " + secondsText(age) + " old; ticks are valid for " + text(valid_for) + " s (~valid_for)";
}

QueryAnswer QueryServices::askBox(const msg::QueryBox::Request& request, const Question& question) const {
  const Pose frame_from_box = fromPose(request.pose, "the query's box");
  const Eigen::Vector3d size(request.size.x, request.size.y, request.size.z);
  return query(question.snapshot, QueryBox{question.world_from_frame * frame_from_box, size}, *narrow_phase_,
               question.scope);
}

QueryAnswer QueryServices::askShape(const msg::QueryShape::Request& request, const Question& question) const {
  const Pose frame_from_shape = fromPose(request.shape.pose, "the query's shape");
  const Shape shape =
      fromShape(request.shape, params_.shapeLimits(), static_cast<std::size_t>(params_.max_mesh_triangles));
  const QueryShape placed{shape, question.world_from_frame * frame_from_shape, request.shape.padding};
  return query(question.snapshot, placed, *narrow_phase_, question.scope);
}

QueryAnswer QueryServices::askNearest(const msg::QueryNearest::Request& request, const Question& question) const {
  QueryScope scope = question.scope;
  if (request.limit == 0) scope.limit = 1;
  if (request.body.empty()) {
    return nearest(question.snapshot, question.world_from_frame * fromPoint(request.point), request.max_distance,
                   scope);
  }
  return nearest(question.snapshot, indexOf(question.snapshot, request.body), request.max_distance, scope);
}

}  // namespace hgrid
