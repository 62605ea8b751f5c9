// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/explain_service.h"

#include <hgrid_proximity/BodyState.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/messages/rule_messages.h"

namespace hgrid {
namespace {

constexpr OptionNames kOptionNames = {"~limits/max_pairs",     "~horizon",     "~pair_kinds",
                                      "~allowed_pairs", "~set_allowed", "~rooms"};

/// Returns the age [s] of the pose of a body when the answer is sent. It is 0 for a fixed body.
/// @param age       [s] age of the pose when the tick was computed; NaN if the body never had a pose
/// @param tick_age  [s] time since the tick was computed
double ageNow(const Body& body, double age, double tick_age) {
  return body.mobility == Mobility::fixed && !std::isnan(age) ? 0.0 : age + tick_age;
}

bool hasPose(const Snapshot& snapshot, std::uint32_t body) {
  return snapshot.poses()[body].state != Freshness::unplaced;
}

/// @throws Refusal unknown_id if the name belongs to a link without geometry, which is no body
void checkHasCollision(const ModelReport& models, const std::string& name) {
  const std::vector<std::string>& bare = models.without_collision;
  if (std::find(bare.begin(), bare.end(), name) == bare.end()) return;
  throw Refusal(Code::unknown_id,
                "link '" + name +
                    "' has no <collision>: its extent is unknown, so it is in no pair; add one, or set ~use_visual");
}

/// Returns a response in which all values are unknown.
msg::ExplainPair::Response blank() {
  msg::ExplainPair::Response response;
  response.gap = response.margin = response.margin_first = response.margin_second = std::nan("");
  response.margin_pair = response.growth = response.distance = std::nan("");
  response.age_first = response.age_second = std::nan("");
  response.state_first = response.state_second = msg::BodyState::UNPLACED;
  return response;
}

}  // namespace

ExplainService::ExplainService(ServiceEnvelope& envelope, const Params& params, const TickHistory& history,
                               std::shared_ptr<const NarrowPhase> narrow_phase)
    : params_(params), history_(history), narrow_phase_(std::move(narrow_phase)) {
  server_ = envelope.serve<msg::ExplainPair>(
      "explain_pair", "explain_pair", [this](ServiceCall<msg::ExplainPair>& call) { explainPair(call); }, blank());
}

void ExplainService::listContacts(const Snapshot& snapshot, const Explanation& what, std::uint32_t most,
                                  msg::ExplainPair::Response& response) const {
  most = std::min(most, static_cast<std::uint32_t>(params_.max_hits));
  std::vector<PairContact> contacts =
      contactsOf(*narrow_phase_, snapshot, what.first, what.second, std::size_t{most} + 1);
  response.contacts_truncated = contacts.size() > most;
  if (response.contacts_truncated) contacts.resize(most);
  for (const PairContact& one : contacts) {
    response.contact_point.push_back(toPoint(one.contact.point));
    response.contact_normal.push_back(toVector(one.contact.normal));
    response.contact_depth.push_back(one.contact.depth);
    response.contact_first_shape.push_back(one.first_shape);
    response.contact_second_shape.push_back(one.second_shape);
  }
}

void ExplainService::fill(const Snapshot& snapshot, const msg::ExplainPair::Request& request, double tick_age,
                          msg::ExplainPair::Response& response) const {
  const std::string &first = request.first, &second = request.second;
  const Structure& structure = snapshot.structure();
  const std::uint32_t a = structure.find(first), b = structure.find(second);
  std::optional<PairDistance> exact;
  if (a != Structure::kNone && b != Structure::kNone && a != b && hasPose(snapshot, a) && hasPose(snapshot, b)) {
    exact = measurePair(*narrow_phase_, snapshot, a, b, std::numeric_limits<double>::infinity());
  }
  const Explanation what = explain(snapshot, first, second, exact ? &*exact : nullptr, kOptionNames);
  response.reported = what.reported;
  response.explanation = what.text;
  if (what.reported) response.flags = snapshot.pairs()[what.position].flags;
  response.rule = toMsg(what.rule, PairRule::Clock::now());
  response.gap = what.gap;
  response.margin = what.margin;
  response.margin_pair = what.margin_pair;
  response.margin_first = what.margin_first;
  response.margin_second = what.margin_second;
  response.growth = what.growth;
  response.distance = what.distance;
  response.narrow_status = static_cast<std::uint8_t>(what.measured);
  response.state_first = static_cast<std::uint8_t>(what.state_first);
  response.state_second = static_cast<std::uint8_t>(what.state_second);
  const BodyList& bodies = snapshot.structure().bodies;
  response.age_first = ageNow(bodies[what.first], what.age_first, tick_age);
  response.age_second = ageNow(bodies[what.second], what.age_second, tick_age);
  if (response.reported) response.since = toRos(what.since);
  if (exact && request.contacts > 0) listContacts(snapshot, what, request.contacts, response);
}

void ExplainService::explainPair(ServiceCall<msg::ExplainPair>& call) const {
  const msg::ExplainPair::Request& request = call.request;
  call.tick.snapshot();  // throws while there is no world
  const std::shared_ptr<const Tick> newest = call.tick.get();
  call.answerFrom(history_.at(request.header.stamp, newest));
  const Snapshot& snapshot = call.tick.snapshot();
  checkHasCollision(*call.tick.get()->models, request.first);
  checkHasCollision(*call.tick.get()->models, request.second);
  fill(snapshot, request, call.tick.age(), call.response);
  const std::string ago = agoText(snapshot, *newest->snapshot);
  if (!ago.empty()) call.response.explanation += " This was so " + ago + ".";
}

}  // namespace hgrid
