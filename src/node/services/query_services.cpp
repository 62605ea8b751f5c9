// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/query_services.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "node/messages/hit_messages.h"
#include "node/queries/quick_query.h"
#include "node/queries/request_checks.h"
#include "node/threads/quick_turn.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

/// Returns which sources are not complete: "not complete: 'map/hall' and 2 more". The world must not be complete.
std::string incompleteText(const Snapshot& snapshot) {
  const std::vector<std::string>& sources = snapshot.incompleteSources();
  const std::string others = sources.size() > 1 ? " and " + std::to_string(sources.size() - 1) + " more" : "";
  return "not complete: '" + sources.front() + "'" + others;
}

/// Returns the summary of a CLEAR answer. It names sources that are not complete but do not affect the verdict.
/// @param asked  number of bodies that the query asks about; nullopt: all bodies
/// @param where  where none of them is: "there"
std::string clearText(const Snapshot& snapshot, std::optional<std::size_t> asked, const std::string& where) {
  const std::string none = asked ? "none of the " + std::to_string(*asked) + " requested bodies" : "nothing";
  const std::string elsewhere = snapshot.complete() ? ""
                                                    : " (" + incompleteText(snapshot) +
                                                          "; the query does not ask about it or it cannot be there)";
  return "CLEAR: " + none + " is " + where + elsewhere;
}

std::string countText(std::size_t bodies) { return std::to_string(bodies) + (bodies == 1 ? " body" : " bodies"); }

/// Returns the summary of an answer.
/// @param asked  as in clearText()
template <class Request>
std::string summaryOf(const Request&, const QueryAnswer& found, const Snapshot& snapshot,
                      std::optional<std::size_t> asked) {
  if (found.verdict == Verdict::unknown) return "UNKNOWN: " + found.reason;
  if (found.verdict == Verdict::clear) return clearText(snapshot, asked, "there");
  const std::string first =
      found.hits.empty() ? "" : ", first " + snapshot.structure().bodies[found.hits.front().body].name;
  return "HIT: " + countText(found.total) + first;
}
/// As above. What is nearest need not touch anything, so the sentence does not say HIT.
std::string summaryOf(const msg::QueryNearest::Request& request, const QueryAnswer& found, const Snapshot& snapshot,
                      std::optional<std::size_t> asked) {
  if (found.verdict == Verdict::unknown) return "UNKNOWN: " + found.reason;
  if (found.verdict == Verdict::clear) {
    return clearText(snapshot, asked,
                     request.max_distance > 0.0 ? "within " + metersText(request.max_distance) : "there");
  }
  const QueryHit& nearest = found.hits.front();
  const std::string late = found.examined_all ? "" : "; the time was over, so another body may be nearer";
  const std::string unseen = snapshot.complete() ? "" : "; " + incompleteText(snapshot);
  return "NEAREST: " + snapshot.structure().bodies[nearest.body].name + " at " + metersText(nearest.distance) + " (" +
         countText(found.hits.size()) + " listed" + late + unseen + ")";
}

/// Returns when a query must end its search. @throws Refusal what deadlineOf() throws
std::optional<std::chrono::steady_clock::time_point> endOf(double max_time) {
  const auto asked = deadlineOf(max_time);
  if (!QuickTurn::here()) return asked;
  const auto quick = std::chrono::steady_clock::now() + kQuickSearch;
  return asked ? std::min(*asked, quick) : quick;
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

/// Turns CLEAR into UNKNOWN if the tick is too old.
void outdate(QueryAnswer& found, const AnswerTick& tick) {
  if (found.verdict != Verdict::clear) return;
  found.reason = tick.whyOutdated();
  if (found.reason.empty()) return;
  found.verdict = Verdict::unknown;
  found.because = Unknown::outdated;
}

}  // namespace

QueryServices::QueryServices(ServiceEnvelope& quick, ServiceEnvelope& envelope, const Params& params,
                             const TransformLookup& transforms, const TickHistory& history,
                             std::shared_ptr<NarrowPhase> narrow_phase, QuerySketch& sketch)
    : params_(params), transforms_(transforms), history_(history), narrow_phase_(std::move(narrow_phase)) {
  serve<msg::QuerySphere>(quick, "query_sphere", [&sketch](const auto& request, const PreparedQuery& question) {
    const Sphere sphere{question.world_from_frame * fromPoint(request.center), request.radius};
    QueryAnswer found = query(question.snapshot, sphere, question.scope);
    QuickTurn::require(found.examined_all);
    sketch.show(sphere, found.verdict);
    return found;
  });
  serve<msg::QuerySegment>(envelope, "query_segment", [&sketch](const auto& request, const PreparedQuery& question) {
    const Segment segment{question.world_from_frame * fromPoint(request.start),
                          question.world_from_frame * fromPoint(request.end), request.radius};
    QueryAnswer found = query(question.snapshot, segment, question.scope);
    sketch.show(segment, found.verdict);
    return found;
  });
  serve<msg::QueryBox>(envelope, "query_box", [this](const auto& request, const PreparedQuery& question) {
    return query(question.snapshot, question.boxOf(request.pose, request.size), *narrow_phase_, question.scope);
  });
  serve<msg::QueryShape>(envelope, "query_shape", [this](const auto& request, const PreparedQuery& question) {
    return query(question.snapshot, question.shapeOf(request.shape, params_), *narrow_phase_, question.scope);
  });
  serve<msg::QueryNearest>(envelope, "query_nearest", [this](const auto& request, const PreparedQuery& question) {
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
  const std::string as_body = asBody(request);
  const QueryOptions options{
      request.header.frame_id,      request.include, request.exclude,        request.limit, request.exact != 0,
      request.respect_allowed != 0, as_body,         endOf(request.max_time)};
  // The history may have to make a past tick again, which takes long.
  QuickTurn::require(!namesItsTime(request.header.stamp) && mayBeQuick(options, *newest));
  call.answerFrom(history_.at(request.header.stamp, newest));
  const Snapshot& snapshot = call.tick.snapshot();
  const PreparedQuery question = prepare(options, *call.tick.get(), params_, transforms_, *narrow_phase_);

  QueryAnswer found = ask(request, question);
  QuickTurn::require(found.hits.size() <= kQuickHits);
  if (!namesItsTime(request.header.stamp)) outdate(found, call.tick);
  if (!question.frame.empty()) call.response.header.frame_id = question.frame;
  msg::Answer& result = call.response.answer;
  const HitWriter writer(snapshot, question.world_from_frame.inverse(), call.tick.age());
  for (const QueryHit& hit : found.hits) result.hits.push_back(writer.message(hit));
  result.code = toMsg(Code::ok, found.reason);
  result.verdict = static_cast<std::uint8_t>(found.verdict);
  result.unknown_because = static_cast<std::uint8_t>(found.because);
  result.summary = summaryOf(request, found, snapshot, question.of);
  const std::string ago = agoText(snapshot, *newest->snapshot);
  if (!ago.empty()) result.summary += " (" + ago + ")";
  result.total = static_cast<std::uint32_t>(found.total);
  result.truncated = found.total > found.hits.size();
}

QueryAnswer QueryServices::askNearest(const msg::QueryNearest::Request& request, const PreparedQuery& question) const {
  QueryScope scope = question.scope;
  if (request.limit == 0) scope.limit = 1;
  if (request.body.empty()) {
    return nearest(question.snapshot, question.world_from_frame * fromPoint(request.point), request.max_distance,
                   scope);
  }
  return nearest(question.snapshot, indexOf(question.snapshot, request.body), request.max_distance, scope);
}

}  // namespace hgrid
