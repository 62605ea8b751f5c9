// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/structure_publisher.h"

#include "node/messages/bodies_message.h"
#include "node/messages/rule_messages.h"
#include "node/services/guarded.h"

namespace hgrid {

StructurePublisher::StructurePublisher(ros::NodeHandle& private_node, const Params& params, Ledger& ledger)
    : params_(params),
      bodies_(private_node.advertise<msg::Bodies>("bodies", 1, true)),
      rules_(private_node.advertise<msg::Rules>("rules", 1, true)),
      thread_([this, &ledger](const std::shared_ptr<const Tick>& tick) {
        const auto failure = guarded(ledger, "structure.failed", [&] {
          bodies_.publish(boost::make_shared<msg::Bodies>(bodiesMessage(*tick)));
          rules_.publish(boost::make_shared<msg::Rules>(rulesMessage(*tick, params_)));
        });
        if (failure) failed_ = true;
      }) {}

void StructurePublisher::publish(const std::shared_ptr<const Tick>& tick) {
  const bool failed = failed_.exchange(false);
  if (watch_.changed(*tick) || failed) thread_.give(tick);
}

}  // namespace hgrid
