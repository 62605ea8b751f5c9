// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "listener.h"

namespace hgrid {
namespace bench {

Listener::Listener(const std::string& node, bool distances) {
  if (distances) distances_ = node_.subscribe<msg::Distances>(node + "/distances", 10, ignore);
  pairs_ =
      node_.subscribe<msg::Pairs>(node + "/pairs", 1000,
                                  boost::function<void(const ros::MessageEvent<msg::Pairs const>&)>(
                                      [this](const ros::MessageEvent<msg::Pairs const>& event) { onPairs(event); }),
                                  ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  status_ = node_.subscribe<msg::Status>(node + "/status", 1000, &Listener::onStatus, this);
}

void Listener::noteIn(Sightings* sightings) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sightings_ = sightings;
}

bool Listener::serves(std::size_t bodies) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_ && newest_->world.complete && newest_->body_count == bodies;
}

std::string Listener::troubles() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!newest_) return "it has published no ~status";
  std::string text = std::to_string(newest_->body_count) + " bodies";
  for (const std::string& reason : newest_->world.reasons) text += "; " + reason;
  return text;
}

void Listener::onPairs(const ros::MessageEvent<msg::Pairs const>& event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const msg::Pairs& pairs = *event.getConstMessage();
  const bool is_new = pairs.header.stamp != last_stamp_;
  last_stamp_ = pairs.header.stamp;
  if (sightings_ == nullptr) return;
  sightings_->pairs += pairs.total;
  ++sightings_->ticks;
  if (is_new) sightings_->seconds["latency"].push_back((event.getReceiptTime() - last_stamp_).toSec());
}

void Listener::onStatus(const msg::Status::ConstPtr& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_ = status;
  if (sightings_ == nullptr) return;
  for (const msg::Timing& timing : status->timings) {
    sightings_->seconds[timing.name == "latency" ? "after data" : timing.name].push_back(timing.last);
  }
}

}  // namespace bench
}  // namespace hgrid
