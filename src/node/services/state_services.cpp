// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/state_services.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "node/messages/body_names.h"
#include "node/messages/to_messages.h"
#include "node/queries/request_checks.h"
#include "node/states/state_question.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 10.0;  // [m] upper limit of max_clearance

template <class Request>
AskedStates askedOf(const Request& request) {
  AskedStates asked{request.robot,
                    request.group,
                    request.joint_names,
                    request.ignore,
                    request.other_joint_names,
                    request.other_positions,
                    {}};
  if (request.use_base) asked.base = request.base;
  return asked;
}

/// Why no answer from a tick can be CLEAR.
struct TickDoubt {
  Unknown because = Unknown::no;
  std::string sentence;

  /// @param doubt        why nobody knows where the robot would be; may be empty
  /// @param names_tick  whether the request names its tick, so that the age does not matter
  TickDoubt(const std::string& doubt, const AnswerTick& tick, bool names_tick) {
    if (!doubt.empty()) {
      because = Unknown::stale_body;
      sentence = doubt;
    } else if (!names_tick) {
      sentence = tick.whyOutdated();
      if (!sentence.empty()) because = Unknown::outdated;
    }
  }
};

/// Writes the parts of a response that states and edges have in common.
template <class Response>
class AnswerWriter {
 public:
  AnswerWriter(const StateChecker& checker, const TickDoubt& doubt, std::size_t count, Response& response)
      : checker_(checker), doubt_(doubt), response_(response) {
    response.codes.reserve(count);
    response.verdicts.reserve(count);
  }
  /// Adds an answer. @param sentence  of the answer; empty: it needs none
  void add(Verdict verdict, Unknown because, Code refused, bool beyond_limits, std::string sentence) {
    if (verdict == Verdict::clear && doubt_.because != Unknown::no) {
      verdict = Verdict::unknown;
      because = doubt_.because;
      sentence = doubt_.sentence;
    }
    response_.codes.push_back(static_cast<std::uint16_t>(refused));
    response_.verdicts.push_back(static_cast<std::uint8_t>(verdict));
    response_.unknown_because.push_back(static_cast<std::uint8_t>(because));
    response_.beyond_limits.push_back(beyond_limits);
    if (sentence.empty() && response_.texts.empty()) return;
    response_.texts.resize(response_.codes.size());
    response_.texts.back() = std::move(sentence);
  }
  /// Adds the pair of an answer. @param pair  null: it has none
  void addPair(const StatePair* pair) {
    response_.first.push_back(pair == nullptr ? kNoBody : pair->first);
    response_.second.push_back(pair == nullptr ? kNoBody : pair->second);
  }
  /// Adds point, normal and depth of an answer.
  void addContact(const Contact& contact) {
    response_.point.push_back(toPoint(contact.point));
    response_.normal.push_back(toVector(contact.normal));
    response_.depth.push_back(contact.depth);
  }
  /// Replaces the indices of bodies by indices into `names`.
  void finish() {
    if (!response_.texts.empty()) response_.texts.resize(response_.codes.size());
    nameBodies(checker_.snapshot().structure().bodies, {&response_.first, &response_.second}, response_.names);
  }

 private:
  const StateChecker& checker_;
  const TickDoubt& doubt_;
  Response& response_;
};

/// Returns the contact of a pair of an edge. If the two only come too near to each other, the depth is not known, and
/// the point is the middle between them.
Contact contactOf(const StatePair& pair) {
  if (isContact(pair.proximity.status)) return pair.contact;
  Contact contact;
  contact.point = 0.5 * (pair.proximity.on_first + pair.proximity.on_second);
  contact.normal = pair.proximity.normal;
  return contact;
}

}  // namespace

StateServices::StateServices(ServiceEnvelope& envelope, const Params& params, const TransformLookup& transforms,
                             Leases& leases, std::shared_ptr<const NarrowPhase> narrow_phase)
    : params_(params), transforms_(transforms), leases_(leases), narrow_phase_(std::move(narrow_phase)) {
  servers_.push_back(envelope.serve<msg::CheckStates>("check_states", [this](auto& call) { answer(call); }));
  servers_.push_back(envelope.serve<msg::CheckEdges>("check_edges", [this](auto& call) { answer(call); }));
}

/// Makes the response from the tick that the request asks for. @returns the newest tick
template <class Service>
std::shared_ptr<const Tick> StateServices::chooseTick(ServiceCall<Service>& call) {
  call.tick.snapshot();  // throws while there is no world
  std::shared_ptr<const Tick> newest = call.tick.get();
  call.answerFrom(leases_.find(call.request.lease, newest));
  return newest;
}

void StateServices::checkCount(const char* what, std::size_t values, std::size_t joints) const {
  checkBatch(what, (values + std::max<std::size_t>(1, joints) - 1) / std::max<std::size_t>(1, joints), params_);
}

void StateServices::answer(ServiceCall<msg::CheckStates>& call) {
  const auto& request = call.request;
  auto& response = call.response;
  const auto end = batchDeadlineOf(request.max_time);
  const std::shared_ptr<const Tick> newest = chooseTick(call);
  checkCount("states", request.positions.size(), request.joint_names.size());
  const StateQuestion question =
      stateQuestion(askedOf(request), request.positions, *call.tick.get(), *newest, transforms_, narrow_phase_, cache_);
  if (request.max_clearance > kFarthest) {
    throw Refusal(Code::out_of_range, "max_clearance is " + text(request.max_clearance) + " m; it must be at most " +
                                          text(kFarthest) + " m");
  }
  StateRequest asked;
  asked.contacts = request.contacts;
  asked.clearance = request.max_clearance;
  asked.gradients = request.gradients;
  asked.deadline = end;
  thread_local StateScratch scratch;  // its memory is used again by the next request
  StateAnswers answers;
  question.checker->checkStates(question.batch, asked, scratch, answers);
  const TickDoubt doubt(question.doubt, call.tick, request.lease.sequence != 0);
  AnswerWriter<msg::CheckStates::Response> writer(*question.checker, doubt, answers.states.size(), response);
  for (std::size_t i = 0; i < answers.states.size(); ++i) {
    const StateAnswer& state = answers.states[i];
    writer.add(state.verdict, state.because, state.refused, state.beyond_limits,
               state.because == Unknown::no ? "" : question.checker->sentenceOf(question.batch, answers, i));
    const StatePair* const pair = state.pairs == 0 ? nullptr : &answers.pairs[state.first_pair];
    writer.addPair(pair);
    if (asked.contacts) writer.addContact(pair == nullptr ? Contact{} : pair->contact);
    if (asked.clearance > 0.0) response.clearance.push_back(state.clearance);
    if (response.verdicts.back() != static_cast<std::uint8_t>(Verdict::unknown)) continue;
    // What nobody sees may be nearer than what was measured.
    if (asked.clearance > 0.0) response.clearance.back() = Proximity::kUnknown;
    const std::size_t width = answers.gradients.size() / answers.states.size();
    std::fill_n(answers.gradients.begin() + static_cast<std::ptrdiff_t>(i * width), width, Proximity::kUnknown);
  }
  writer.finish();
  response.gradient = std::move(answers.gradients);
  response.lease = leases_.keep(request.lease, call.tick.get());
}

void StateServices::answer(ServiceCall<msg::CheckEdges>& call) {
  const auto& request = call.request;
  auto& response = call.response;
  const auto end = batchDeadlineOf(request.max_time);
  const std::shared_ptr<const Tick> newest = chooseTick(call);
  const std::size_t width = request.joint_names.size();
  if (request.start.size() != request.end.size() || (width > 0 && request.start.size() % width != 0)) {
    throw Refusal(Code::out_of_range, "start has " + std::to_string(request.start.size()) + " values and end has " +
                                          std::to_string(request.end.size()) +
                                          "; both must have one row of joint_names.size() = " + std::to_string(width) +
                                          " values for each edge");
  }
  checkCount("edges", request.start.size(), width);
  std::vector<double> positions = request.start;
  positions.insert(positions.end(), request.end.begin(), request.end.end());
  const auto count = static_cast<std::uint32_t>(width == 0 ? 0 : request.start.size() / width);
  const StateQuestion question = stateQuestion(askedOf(request), std::move(positions), *call.tick.get(), *newest,
                                               transforms_, narrow_phase_, cache_);
  std::vector<StateEdge> edges;
  for (std::uint32_t i = 0; i < count; ++i) edges.push_back({i, count + i});
  EdgeRequest asked;
  if (request.tolerance != 0.0) asked.tolerance = request.tolerance;
  asked.any_contact = request.any_contact;
  asked.contacts = true;
  asked.deadline = end;
  thread_local StateScratch scratch;  // its memory is used again by the next request
  EdgeAnswers answers;
  question.checker->checkEdges(question.batch, edges, asked, scratch, answers);
  const TickDoubt doubt(question.doubt, call.tick, request.lease.sequence != 0);
  AnswerWriter<msg::CheckEdges::Response> writer(*question.checker, doubt, answers.edges.size(), response);
  for (std::size_t i = 0; i < answers.edges.size(); ++i) {
    const EdgeAnswer& edge = answers.edges[i];
    const StatePair* const pair = edge.pairs == 0 ? nullptr : &answers.pairs[edge.first_pair];
    writer.add(edge.verdict, edge.because, edge.refused, edge.beyond_limits,
               edge.because == Unknown::no ? "" : question.checker->sentenceOf(question.batch, answers, i));
    writer.addPair(pair);
    response.free_until.push_back(doubt.because == Unknown::no ? edge.free_until : 0.0);
    response.at.push_back(edge.at);
    writer.addContact(pair == nullptr ? Contact{} : contactOf(*pair));
  }
  writer.finish();
  response.lease = leases_.keep(request.lease, call.tick.get());
}

}  // namespace hgrid
