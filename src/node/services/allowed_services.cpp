// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/allowed_services.h"

#include <ros/console.h>

#include <algorithm>

#include "hgrid_proximity/explain/allowed_matrix.h"
#include "hgrid_proximity/pairs/rule_book.h"
#include "node/messages/rule_messages.h"
#include "node/services/guarded.h"

namespace hgrid {
namespace {

void checkGlob(const std::string& glob) {
  if (glob.size() <= kLongestRuleText) return;
  throw Refusal(Code::bad_id, "glob '" + printable(glob, 48) + "' has " + std::to_string(glob.size()) +
                                  " bytes; at most " + std::to_string(kLongestRuleText) + " are allowed");
}

/// What there is in the world. @throws Refusal not_ready
const Structure& structureOf(const std::shared_ptr<const Tick>& tick) {
  if (!tick) throw Refusal(Code::not_ready, "there is no world yet: the first tick was not made");
  if (!tick->snapshot) throw Refusal(Code::not_ready, "there is no world yet: " + tick->not_ready.front());
  return tick->snapshot->structure();
}

}  // namespace

AllowedServices::AllowedServices(ros::NodeHandle& node, AdminAnswer answer) : answer_(std::move(answer)) {
  servers_.push_back(advertiseGuarded(node, "set_allowed", &AllowedServices::onSet, this, answer_.ledger));
  servers_.push_back(advertiseGuarded(node, "get_allowed", &AllowedServices::onGet, this, answer_.ledger));
}

/// All rules as they will be when the request is done. @throws Refusal if it may not be done
std::vector<PairRule> AllowedServices::rulesAfter(const msg::SetAllowed::Request& request,
                                                  const Structure& structure) const {
  const auto most = static_cast<std::size_t>(answer_.params.max_rules);
  if (request.rules.size() > most) {
    throw Refusal(Code::limit, "the request has " + std::to_string(request.rules.size()) + " rules; at most " +
                                   std::to_string(most) + " are allowed (~max_rules)");
  }
  const std::vector<PairRule> rules = rulesOf(request.rules, PairRule::Clock::now());
  RuleBook book(structure.filter.rules(), most);
  if (request.remove) {
    book.remove(rules);
  } else {
    checkKnown(rules, structure.bodies);
    book.add(rules);
  }
  const PairFilter filter(structure.bodies, answer_.params.pair_kinds, book.rules());
  if (silencesAll(structure.bodies, answer_.params.pair_kinds, filter)) {
    if (!request.force) {
      throw Refusal(Code::needs_force,
                    "no pair of bodies would be reported any more; ask with force = true if so meant");
    }
    ROS_WARN("Rules of ~set_allowed switch off every pair: nothing is reported any more.");
  }
  return book.rules();
}

bool AllowedServices::onSet(Checked<msg::SetAllowed::Request>& checked, msg::SetAllowed::Response& response) {
  return answer_("set_allowed", response, [&](std::shared_ptr<const Tick>& tick) {
    const msg::SetAllowed::Request& request = checked.value();
    const std::vector<PairRule> rules = rulesAfter(request, structureOf(tick));
    tick = answer_.do_in_tick([rules](World& world) { world.setRules(rules); });
  });
}

bool AllowedServices::onGet(Checked<msg::GetAllowed::Request>& checked, msg::GetAllowed::Response& response) {
  return answer_("get_allowed", response, [&](const std::shared_ptr<const Tick>& tick) {
    const msg::GetAllowed::Request& request = checked.value();
    const Structure& structure = structureOf(tick);
    checkGlob(request.first);
    checkGlob(request.second);
    const auto most = static_cast<std::uint32_t>(answer_.params.max_pairs);
    const AllowedScope scope{request.first, request.second, request.limit == 0 ? most : std::min(request.limit, most)};
    const AllowedList list = request.rules ? givenRules(structure, scope) : decidedPairs(structure, scope);
    const auto now = PairRule::Clock::now();
    for (const PairRule& entry : list.entries) response.entries.push_back(toMsg(entry, now));
    response.total = static_cast<std::uint32_t>(list.total);
    response.truncated = list.total > list.entries.size();
    if (request.as_srdf) response.srdf = srdfOf(structure, list.entries);
  });
}

}  // namespace hgrid
