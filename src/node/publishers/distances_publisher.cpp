// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/publishers/distances_publisher.h"

#include <chrono>
#include <utility>

#include "node/health/guarded.h"
#include "node/messages/distances_messages.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {
namespace {

PairMeter meterOf(const Commons& commons) {
  const Params& params = commons.settings.params;
  return {commons.narrow_phase, {params.reportDistance(), params.distances_budget, params.distances_threads}};
}

}  // namespace

DistancesPublisher::DistancesPublisher(ros::NodeHandle& private_node, Commons& commons)
    : commons_(commons),
      publisher_(private_node.advertise<msg::Distances>("distances", 1)),
      meter_(meterOf(commons)),
      thread_([this](const Request& request) {
        commons_.health.noteDistances(guarded(commons_.ledger, "distances.fault", [&] { measure(request); }));
      }) {}

std::optional<std::chrono::nanoseconds> DistancesPublisher::publish(const std::shared_ptr<const Tick>& tick,
                                                                    bool also_wanted) {
  const bool published = publisher_.getNumSubscribers() > 0;
  const bool was_needed = std::exchange(needed_, published || also_wanted);
  if (!needed_ && !was_needed) return std::nullopt;
  const bool dropped = thread_.give({needed_ ? tick : nullptr, published});
  if (dropped && was_needed) commons_.ledger.count("distances.skipped");
  const auto last = std::exchange(reported_, measured());
  if (!reported_ || reported_ == last) return std::nullopt;
  return reported_->time;
}

void DistancesPublisher::measure(const Request& request) {
  if (!request.tick) return std::atomic_store(&measured_, {});
  const auto begin = std::chrono::steady_clock::now();
  auto measured = std::make_shared<MeasuredTick>();
  measured->tick = request.tick;
  const Params& params = request.tick->settings->params;
  meter_.tune(params.reportDistance(), params.distances_budget);
  if (request.tick->snapshot) measured->distances = meter_.measure(*request.tick->snapshot);
  commons_.health.noteThreads("~distances/threads", params.distances_threads, meter_.threads());
  measured->time = std::chrono::steady_clock::now() - begin;
  std::atomic_store(&measured_, std::shared_ptr<const MeasuredTick>(measured));
  const PairDistances* distances = measured->distances.get();
  if (request.published) {
    const msg::WorldState world = worldState(*request.tick, 0.0);
    publisher_.publish(distancesMessage(*request.tick, world, distances, params));
  }
  commons_.health.noteLongestWait(distances ? distances->longest_wait : 0);
  if (!distances) return;
  if (distances->left_out > 0) commons_.ledger.count("distances.left_out", distances->left_out);
  if (distances->failed > 0) commons_.ledger.count("distances.failed", distances->failed);
}

}  // namespace hgrid
