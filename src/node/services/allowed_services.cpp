// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/allowed_services.h"

#include <ros/console.h>

#include <algorithm>
#include <utility>

#include "hgrid_proximity/explain/allowed_matrix.h"
#include "hgrid_proximity/explain/changed_pairs.h"
#include "hgrid_proximity/pairs/rule_book.h"
#include "node/messages/rule_messages.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

void checkGlob(const std::string& glob) {
  if (glob.size() <= kLongestRuleText) return;
  throw Refusal(Code::bad_id, "glob '" + printable(glob, 48) + "' has " + std::to_string(glob.size()) +
                                  " bytes; at most " + std::to_string(kLongestRuleText) + " are allowed");
}

}  // namespace

AllowedServices::AllowedServices(ServiceEnvelope& envelope, const Params& params, ChangeWorld change_world,
                                 WaitUntilStored wait_until_stored)
    : params_(params), change_world_(std::move(change_world)), wait_until_stored_(std::move(wait_until_stored)) {
  servers_.push_back(
      envelope.serve<msg::SetAllowed>("set_allowed", [this](ServiceCall<msg::SetAllowed>& call) { set(call); }));
  servers_.push_back(
      envelope.serve<msg::GetAllowed>("get_allowed", [this](ServiceCall<msg::GetAllowed>& call) { get(call); }));
}

/// Returns the pair filter with the rules that the request asks for. @throws Refusal if the request is not valid
PairFilter AllowedServices::filterAfter(const ServiceCall<msg::SetAllowed>& call, const Structure& structure) const {
  const msg::SetAllowed::Request& request = call.request;
  const auto most = static_cast<std::size_t>(params_.max_rules);
  if (request.rules.size() > most) {
    throw Refusal(Code::limit, "the request has " + std::to_string(request.rules.size()) + " rules; at most " +
                                   std::to_string(most) + " are allowed (~limits/max_rules)");
  }
  const std::vector<PairRule> rules = rulesOf(request.rules, call.caller, thisMoment());
  RuleBook book(structure.filter.rules(), most);
  if (request.remove) {
    book.remove(rules);
  } else {
    checkKnown(rules, structure.bodies);
    book.add(rules);
  }
  return PairFilter(structure.bodies, params_.pair_kinds, book.rules());
}

/// Checks that the filter leaves at least one pair that can be reported.
/// @throws Refusal needs_force if it leaves none and `force` is false
void AllowedServices::checkNotSilenced(const Structure& structure, const PairFilter& filter, bool force) const {
  if (!silencesAll(structure.bodies, params_.pair_kinds, filter)) return;
  if (!force) {
    throw Refusal(Code::needs_force,
                  "with these rules no pair of bodies would ever be reported; set force = true if this is intended");
  }
  ROS_WARN("The rules of ~set_allowed switch off every pair: no pair is reported from now on.");
}

void AllowedServices::set(ServiceCall<msg::SetAllowed>& call) const {
  const Structure& structure = call.tick.snapshot().structure();
  const PairFilter filter = filterAfter(call, structure);
  checkNotSilenced(structure, filter, call.request.force);
  const std::uint64_t changed = changedPairs(structure.bodies, structure.filter, filter);
  // The filter is passed on, because making it of many rules and bodies would delay the tick.
  const PreparedRules rules{filter, structure.revision};
  call.tick = AnswerTick(change_world_([rules](World& world) { world.setRules(rules); }));
  call.response.durable = wait_until_stored_();
  const auto count = static_cast<unsigned long long>(changed);
  ROS_INFO("%s %s %zu rules by ~set_allowed, which switches %llu pairs of bodies off or on again", call.caller.c_str(),
           call.request.remove ? "removed" : "added", call.request.rules.size(), count);
  call.response.pairs_changed = static_cast<std::uint32_t>(std::min<std::uint64_t>(changed, 0xffffffffu));
}

void AllowedServices::get(ServiceCall<msg::GetAllowed>& call) const {
  const msg::GetAllowed::Request& request = call.request;
  msg::GetAllowed::Response& response = call.response;
  const Structure& structure = call.tick.snapshot().structure();
  checkGlob(request.first);
  checkGlob(request.second);
  const auto most = static_cast<std::uint32_t>(params_.max_pairs);
  const AllowedScope scope{request.first, request.second, request.limit == 0 ? most : std::min(request.limit, most)};
  const AllowedList list = request.rules ? givenRules(structure, scope) : decidedPairs(structure, scope);
  const auto now = PairRule::Clock::now();
  for (const PairRule& entry : list.entries) response.entries.push_back(toMsg(entry, now));
  response.total = static_cast<std::uint32_t>(list.total);
  response.truncated = list.total > list.entries.size();
  if (request.as_srdf) response.srdf = srdfOf(structure, list.entries);
}

}  // namespace hgrid
