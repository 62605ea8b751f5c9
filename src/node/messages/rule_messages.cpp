// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/rule_messages.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"
#include "node/messages/to_messages.h"

namespace hgrid {

std::vector<PairRule> rulesOf(const std::vector<msg::AllowedPair>& pairs, const std::string& set_by,
                              const Moment& now) {
  std::vector<PairRule> rules;
  for (const msg::AllowedPair& pair : pairs) {
    PairRule rule;
    rule.first = pair.first;
    rule.second = pair.second;
    rule.reason = pair.reason;
    rule.allowed = pair.allowed;
    rule.origin = Origin::service;
    rule.set_by = set_by;
    rule.since = now.ros;
    checkRule(rule);
    const std::int64_t lifetime = pair.lifetime.toNSec();
    if (lifetime < 0) {
      throw Refusal(Code::out_of_range, "the lifetime of rule '" + rule.first + "', '" + rule.second + "' is " +
                                            text(pair.lifetime.toSec()) +
                                            " s; it must not be negative; 0 means no end");
    }
    if (lifetime > 0 && lifetime < 1000000) {
      throw Refusal(Code::out_of_range, "the lifetime of rule '" + rule.first + "', '" + rule.second + "' is " +
                                            std::to_string(lifetime) +
                                            " ns; it must be 0 (no end) or at least 0.001 s; 20 s is {secs: 20}");
    }
    if (lifetime > 0) rule.ends = now.steady + std::chrono::nanoseconds(lifetime);
    rules.push_back(rule);
  }
  return rules;
}

msg::AllowedPair toMsg(const PairRule& rule, PairRule::Clock::time_point now) {
  msg::AllowedPair pair;
  pair.first = rule.first;
  pair.second = rule.second;
  pair.allowed = rule.allowed;
  pair.reason = rule.reason;
  pair.origin = static_cast<std::uint8_t>(rule.origin);
  pair.set_by = rule.set_by;
  pair.since = toRos(rule.since);
  if (rule.ends != PairRule::Clock::time_point::max()) {
    const std::chrono::nanoseconds left = rule.ends - now;
    pair.lifetime.fromNSec(std::max<std::int64_t>(1, left.count()));  // 0 would mean that the rule never ends
  }
  return pair;
}

msg::Rules rulesMessage(const Tick& tick, const Params& params) {
  msg::Rules message;
  message.header = headerOf(tick);
  message.epoch = tick.epoch;
  if (tick.snapshot) message.bodies_revision = tick.snapshot->structure().revision;
  const auto now = PairRule::Clock::now();
  for (const PairRule& rule : tick.snapshot ? tick.snapshot->structure().filter.rules() : params.allowed_pairs) {
    message.rules.push_back(toMsg(rule, now));
  }
  return message;
}

}  // namespace hgrid
