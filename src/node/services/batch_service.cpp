// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/batch_service.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <utility>

#include "node/queries/batch_answers.h"
#include "node/queries/request_checks.h"
#include "node/services/asked_tick.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

using Request = msg::QueryBatch::Request;

constexpr std::size_t kMostHits = 1000000;  // upper limit of the hits in a response

/// Checks that two arrays of a request, which describe the same questions, have the same length.
void checkLengths(const char* first, std::size_t of_first, const char* second, std::size_t of_second) {
  if (of_first == of_second) return;
  throw Refusal(Code::out_of_range, std::string(first) + " has " + std::to_string(of_first) + " elements and " +
                                        second + " has " + std::to_string(of_second) +
                                        "; the two must have equally many elements");
}

/// Checks the lengths of all arrays. Returns the number of questions.
std::size_t countOf(const Request& request, const Params& params) {
  checkLengths("sphere_center", request.sphere_center.size(), "sphere_radius", request.sphere_radius.size());
  checkLengths("segment_start", request.segment_start.size(), "segment_end", request.segment_end.size());
  checkLengths("segment_start", request.segment_start.size(), "segment_radius", request.segment_radius.size());
  checkLengths("box_pose", request.box_pose.size(), "box_size", request.box_size.size());
  const std::size_t count = request.sphere_center.size() + request.segment_start.size() + request.box_pose.size() +
                            request.shape.size() + request.nearest_to_point.size() + request.nearest_to_body.size();
  checkBatch("questions", count, params);
  return count;
}

/// Asks the questions of a request, one after the other.
class Questions {
 public:
  Questions(const PreparedQuery& question, BatchAnswers& answers) : question_(question), answers_(answers) {}

  /// Asks questions of one kind.
  /// @param kind  names a question in sentences
  /// @param ask   function (index) that returns the QueryAnswer
  template <class Ask>
  void ask(const char* kind, std::size_t count, const Ask& ask) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::chrono::steady_clock::now() >= question_.scope.deadline) {
        QueryAnswer none;
        none.examined_all = false;
        answers_.add(none);
        continue;
      }
      try {
        answers_.add(ask(i));
      } catch (const Refusal& refusal) {
        answers_.refuse(refusal.code(), std::string(kind) + " " + std::to_string(i) + ": " + refusal.what());
      }
    }
  }

 private:
  const PreparedQuery& question_;
  BatchAnswers& answers_;
};

}  // namespace

BatchService::BatchService(ServiceEnvelope& envelope, const Params& params, const TransformLookup& transforms,
                           const TickHistory& history, Leases& leases, std::shared_ptr<NarrowPhase> narrow_phase)
    : params_(params),
      transforms_(transforms),
      history_(history),
      leases_(leases),
      narrow_phase_(std::move(narrow_phase)),
      server_(envelope.serve<msg::QueryBatch>("query_batch", [this](auto& call) { answer(call); })) {}

/// Reads the options that all questions of the request have in common.
PreparedQuery BatchService::questionOf(const ServiceCall<msg::QueryBatch>& call) const {
  const auto& request = call.request;
  const QueryOptions options{request.header.frame_id, request.include,
                             request.exclude,         std::max(request.limit, 1u),
                             request.exact != 0,      request.respect_allowed != 0,
                             request.as_body,         batchDeadlineOf(request.max_time)};
  return prepare(options, *call.tick.get(), params_, transforms_, *narrow_phase_);
}

void BatchService::answer(ServiceCall<msg::QueryBatch>& call) {
  const auto& request = call.request;
  auto& response = call.response;
  answerFromAskedTick(call, leases_, history_);
  const std::size_t count = countOf(request, params_);
  const PreparedQuery question = questionOf(call);
  const QueryScope& scope = question.scope;
  if (scope.limit > kMostHits / std::max<std::size_t>(count, 1)) {
    throw Refusal(Code::limit, "the request has " + std::to_string(count) + " questions with up to " +
                                   std::to_string(scope.limit) + " hits each; a response has at most " +
                                   std::to_string(kMostHits) +
                                   " hits. Send fewer questions in a request, or lower limit");
  }
  const Snapshot& snapshot = question.snapshot;
  const Pose& world_from_frame = question.world_from_frame;
  BatchAnswers answers(question, namesItsTick(request) ? "" : call.tick.whyOutdated(), call.tick.age(), response);
  answers.expect(count, !request.segment_start.empty(), !request.nearest_to_body.empty());
  Questions questions(question, answers);
  questions.ask("sphere", request.sphere_center.size(), [&](std::size_t i) {
    return query(snapshot, Sphere{world_from_frame * fromPoint(request.sphere_center[i]), request.sphere_radius[i]},
                 scope);
  });
  questions.ask("segment", request.segment_start.size(), [&](std::size_t i) {
    return query(snapshot,
                 Segment{world_from_frame * fromPoint(request.segment_start[i]),
                         world_from_frame * fromPoint(request.segment_end[i]), request.segment_radius[i]},
                 scope);
  });
  questions.ask("box", request.box_pose.size(), [&](std::size_t i) {
    return query(snapshot, question.boxOf(request.box_pose[i], request.box_size[i]), *narrow_phase_, scope);
  });
  questions.ask("shape", request.shape.size(), [&](std::size_t i) {
    return query(snapshot, question.shapeOf(request.shape[i], params_), *narrow_phase_, scope);
  });
  questions.ask("point", request.nearest_to_point.size(), [&](std::size_t i) {
    return nearest(snapshot, world_from_frame * fromPoint(request.nearest_to_point[i]), request.max_distance, scope);
  });
  questions.ask("body", request.nearest_to_body.size(), [&](std::size_t i) {
    return nearest(snapshot, indexOf(snapshot, request.nearest_to_body[i]), request.max_distance, scope);
  });
  answers.finish();
  if (!question.frame.empty()) response.header.frame_id = question.frame;
  response.lease = leases_.keep(request.lease, call.tick.get());
}

}  // namespace hgrid
