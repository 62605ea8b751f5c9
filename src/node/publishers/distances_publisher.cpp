// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/distances_publisher.h"

#include "node/messages/distances_messages.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {
namespace {

PairMeter meterOf(const Commons& commons) {
  const Params& params = commons.settings.params;
  return {commons.narrow_phase, {params.distances_max, params.distances_budget, params.distances_threads}};
}

}  // namespace

DistancesPublisher::DistancesPublisher(ros::NodeHandle& private_node, Commons& commons)
    : commons_(commons), publisher_(private_node.advertise<msg::Distances>("distances", 1)), meter_(meterOf(commons)) {}

void DistancesPublisher::publish(const std::shared_ptr<const Tick>& tick, bool also_wanted) {
  const bool wanted = publisher_.getNumSubscribers() > 0;
  if (!wanted && !also_wanted) return std::atomic_store(&measured_, {});
  auto measured = std::make_shared<MeasuredTick>();
  measured->tick = tick;
  if (tick->snapshot) measured->distances = meter_.measure(*tick->snapshot);
  std::atomic_store(&measured_, std::shared_ptr<const MeasuredTick>(measured));
  if (!wanted) return;
  const Settings& settings = commons_.settings;
  const msg::WorldState world = worldState(*tick, settings.params, settings.config_hash, 0.0);
  publisher_.publish(distancesMessage(*tick, world, measured->distances.get(), settings.params));
  if (!measured->distances) return;
  if (measured->distances->left_out > 0) commons_.ledger.count("distances.left_out", measured->distances->left_out);
  if (measured->distances->failed > 0) commons_.ledger.count("distances.failed", measured->distances->failed);
}

}  // namespace hgrid
