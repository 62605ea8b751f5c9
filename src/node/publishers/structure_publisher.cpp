// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/structure_publisher.h"

#include "node/health/guarded.h"
#include "node/messages/bodies_message.h"
#include "node/messages/rule_messages.h"

namespace hgrid {

StructurePublisher::StructurePublisher(ros::NodeHandle& private_node, Commons& commons)
    : commons_(commons),
      bodies_(private_node.advertise<msg::Bodies>("bodies", 1, true)),
      rules_(private_node.advertise<msg::Rules>("rules", 1, true)),
      thread_([this](const std::shared_ptr<const Tick>& tick) {
        const auto failure = guarded(commons_.ledger, "structure.failed", [&] { publishNow(*tick); });
        commons_.health.noteStructure(failure);
        if (failure) failed_ = true;
      }) {}

void StructurePublisher::publish(const std::shared_ptr<const Tick>& tick) {
  const bool failed = failed_.exchange(false);
  if (watch_.changed(*tick) || failed) thread_.give(tick);
}

void StructurePublisher::publishNow(const Tick& tick) {
  // Both messages are made before one is published. Otherwise, while ~rules cannot be made, each tick would publish
  // ~bodies again.
  const auto bodies = boost::make_shared<msg::Bodies>(bodiesMessage(tick));
  const auto rules = boost::make_shared<msg::Rules>(rulesMessage(tick, commons_.settings.params));
  bodies_.publish(bodies);
  rules_.publish(rules);
}

}  // namespace hgrid
