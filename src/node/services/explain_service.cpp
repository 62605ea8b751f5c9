// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/explain_service.h"

#include <hgrid_proximity/BodyState.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "node/messages/rule_messages.h"
#include "node/messages/snapshot_stamp.h"
#include "node/services/guarded.h"

namespace hgrid {
namespace {

constexpr OptionNames kOptionNames = {"~max_pairs", "~horizon", "~pair_kinds", "~allowed_pairs", "~set_allowed"};

/// Age of a body's pose as it is when the answer is given; what is fixed does not age.
double ageNow(const Body& body, double age, double age_since) {
  return body.mobility == Mobility::fixed && !std::isnan(age) ? 0.0 : age + age_since;
}

bool hasPose(const Snapshot& snapshot, std::uint32_t body) {
  return snapshot.poses()[body].state != Freshness::unplaced;
}

/// An answer in which nothing is known.
msg::ExplainPair::Response nothing() {
  msg::ExplainPair::Response response;
  response.gap = response.margin = response.margin_first = response.margin_second = std::nan("");
  response.margin_pair = response.growth = response.distance = std::nan("");
  response.age_first = response.age_second = std::nan("");
  response.state_first = response.state_second = msg::BodyState::UNPLACED;
  return response;
}

}  // namespace

ExplainService::ExplainService(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash,
                               NewestTick newest, std::shared_ptr<const NarrowPhase> narrow_phase, Ledger& ledger)
    : params_(params),
      config_hash_(config_hash),
      newest_(std::move(newest)),
      narrow_phase_(std::move(narrow_phase)),
      ledger_(ledger) {
  server_ = advertiseGuarded(node, "explain_pair", &ExplainService::onExplain, this, ledger_);
}

void ExplainService::listContacts(msg::ExplainPair::Response& response, const Snapshot& snapshot,
                                  const Explanation& what, std::uint32_t most) const {
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

void ExplainService::explainTo(msg::ExplainPair::Response& response, const Snapshot& snapshot,
                               const msg::ExplainPair::Request& request, double age_since) const {
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
  const std::vector<Body>& bodies = snapshot.structure().bodies;
  response.age_first = ageNow(bodies[what.first], what.age_first, age_since);
  response.age_second = ageNow(bodies[what.second], what.age_second, age_since);
  if (response.reported) response.since = toRos(what.since);
  if (exact && request.contacts > 0) listContacts(response, snapshot, what, request.contacts);
}

bool ExplainService::onExplain(Checked<msg::ExplainPair::Request>& checked, msg::ExplainPair::Response& response) {
  const std::shared_ptr<const Tick> tick = newest_();
  response = nothing();
  ledger_.count("explain_pair.asked");
  try {
    if (!tick) {
      response.world.worst_state = msg::BodyState::UNPLACED;
      throw Refusal(Code::not_ready, "there is no world yet: the first tick was not made");
    }
    const std::chrono::duration<double> age_since = std::chrono::steady_clock::now() - tick->made.steady;
    response.header = headerOf(*tick);
    response.world = worldState(*tick, params_, config_hash_, age_since.count());
    const msg::ExplainPair::Request& request = checked.value();
    if (!tick->snapshot) throw Refusal(Code::not_ready, "there is no world yet: " + tick->not_ready.front());
    for (const std::string* name : {&request.first, &request.second}) {
      const std::vector<std::string>& bare = tick->models->without_collision;
      if (std::find(bare.begin(), bare.end(), *name) != bare.end()) {
        throw Refusal(Code::unknown_id,
                      "link '" + *name + "' has no <collision>: nothing is known of its extent, and it makes no pair");
      }
    }
    checkStamp(request.header.stamp, *tick->snapshot);
    explainTo(response, *tick->snapshot, request, age_since.count());
    response.code = toMsg(Code::ok, "");
    response.success = true;
  } catch (const Refusal& refusal) {
    response.code = toMsg(refusal.code(), refusal.what());
    response.explanation = refusal.what();
    ledger_.refuse("explain_pair.refused", refusal);
  } catch (...) {  // a fault of the node's own: the caller hears of it, the node goes on
    const Refusal fault = ledger_.fault("explain_pair.failed");
    response.code = toMsg(fault.code(), fault.what());
  }
  return true;
}

}  // namespace hgrid
