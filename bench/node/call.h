// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/service_client.h>

#include <stdexcept>

namespace hgrid {
namespace bench {

/// Calls a service of the node. @throws std::runtime_error if it does not answer, or answers without success
template <class Service>
void call(ros::ServiceClient& client, Service& service) {
  if (!client.call(service)) throw std::runtime_error(client.getService() + " did not answer");
  if (!service.response.success) throw std::runtime_error(client.getService() + ": " + service.response.code.text);
}

}  // namespace bench
}  // namespace hgrid
