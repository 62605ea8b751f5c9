// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/rules_publisher.h"

#include "node/messages/rule_messages.h"

namespace hgrid {

RulesPublisher::RulesPublisher(ros::NodeHandle& private_node, const Params& params)
    : params_(params), publisher_(private_node.advertise<msg::Rules>("rules", 1, true)) {}

void RulesPublisher::publish(const Tick& tick) {
  if (watch_.changed(tick)) publisher_.publish(boost::make_shared<msg::Rules>(rulesMessage(tick, params_)));
}

}  // namespace hgrid
