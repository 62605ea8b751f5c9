// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/bodies_publisher.h"

#include "node/messages/bodies_message.h"
#include "node/messages/to_messages.h"

namespace hgrid {

BodiesPublisher::BodiesPublisher(ros::NodeHandle& private_node)
    : publisher_(private_node.advertise<msg::Bodies>("bodies", 1, true)) {}

void BodiesPublisher::publish(const Tick& tick) {
  if (watch_.changed(tick)) publisher_.publish(boost::make_shared<msg::Bodies>(bodiesMessage(tick)));
}

}  // namespace hgrid
