// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tracks/track_source.h"

#include <geometry_msgs/PoseArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <boost/make_shared.hpp>
#include <chrono>
#include <cmath>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/health/guarded.h"
#include "node/wire/bytes_subscriber.h"

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kLongestPause{50};  // longest time between two looks for tracks that end
constexpr std::chrono::milliseconds kLookAgain{2};      // pause between two checks for a missing transform

}  // namespace

TrackSource::TrackSource(ros::NodeHandle node, const TrackerParams& tracker, double max_speed, const Params& params,
                         const TransformLookup& transforms, std::function<std::shared_ptr<const Tick>()> newest,
                         Sink sink, Ledger& ledger)
    : tracker_(tracker),
      what_("a message of tracker '" + tracker.name + "' on " + tracker.topic),
      counter_("track/" + tracker.name + "."),
      failed_(counter_ + "failed"),
      params_(params),
      transforms_(transforms),
      newest_(std::move(newest)),
      sink_(std::move(sink)),
      ledger_(ledger),
      queue_(static_cast<std::size_t>(params.track_queue_bytes)),
      list_(tracker, max_speed, params, ros::Time::isSimTime()),
      thread_([this] { run(); }) {
  subscribe(node);
}

TrackSource::~TrackSource() {
  subscriber_.shutdown();
  queue_.end();
  thread_.join();
}

void TrackSource::subscribe(ros::NodeHandle& node) {
  const bool markers = tracker_.type == TrackerType::markers;
  ros::SubscribeOptions options = bytesOptions(tracker_.topic, 1, static_cast<std::size_t>(params_.track_queue_bytes),
                                               [this](const BytesEvent& event) { onMessage(event); });
  options.datatype = markers ? ros::message_traits::datatype<visualization_msgs::MarkerArray>()
                             : ros::message_traits::datatype<geometry_msgs::PoseArray>();
  options.md5sum = markers ? ros::message_traits::md5sum<visualization_msgs::MarkerArray>()
                           : ros::message_traits::md5sum<geometry_msgs::PoseArray>();
  node.setCallbackQueue(&immediately_);
  subscriber_ = node.subscribe(options);
}

/// Puts the message into the queue. The thread that receives the message calls this.
void TrackSource::onMessage(const ros::MessageEvent<const MessageBytes>& event) {
  guarded(ledger_, failed_.c_str(), [&] {
    ledger_.count(counter_ + "received");
    const std::size_t dropped = queue_.push({event.getConstMessage(), thisMoment()});
    if (dropped > 0) ledger_.count(counter_ + "dropped.LIMIT", dropped);
  });
}

void TrackSource::run() {
  while (!queue_.ended()) {
    guarded(ledger_, failed_.c_str(), [this] {
      if (const auto received = queue_.popFor(kLongestPause)) handle(*received);
      if (list_.forget(thisMoment())) put();
    });
  }
}

void TrackSource::handle(const ReceivedTracks& received) {
  Refusal refused(Code::ok, "");
  try {
    take(received);
    ledger_.count(counter_ + "applied");
  } catch (const Refusal& refusal) {
    refused = refusal;
  } catch (...) {
    refused = caughtRefusal();
  }
  if (refused.code() != Code::ok) {
    refused = Refusal(refused.code(), what_ + " was refused: " + refused.what());
    list_.noteRefused(std::string(name(refused.code())) + " " + refused.what());
    grace_.refuse(ledger_, counter_ + "refused", refused);
  }
  put();
}

void TrackSource::take(const ReceivedTracks& received) {
  if (received.message->size > static_cast<std::size_t>(params_.track_queue_bytes)) {
    throw Refusal(Code::limit, "it has " + std::to_string(received.message->size) + " bytes; at most " +
                                   std::to_string(params_.track_queue_bytes) +
                                   " are allowed (~limits/track_queue_bytes)");
  }
  const std::shared_ptr<const Tick> tick = newest_();
  if (!tick || tick->world_frame.empty()) {
    throw Refusal(Code::not_ready, "the world frame is not known yet; load the first robot or set ~world_frame");
  }
  const TrackReport report = readTrackReport(received.message->bytes, tracker_, received.arrival, params_.max_future);
  std::vector<std::string> frames;
  for (const auto& [frame, stamp] : framesOf(report)) {
    if (frames.empty() || frames.back() != frame) frames.push_back(frame);
  }
  if (frames != frames_) {
    sink_.follow(frames);
    frames_ = std::move(frames);
  }
  waitFor(report, tick->world_frame);
  const std::vector<PlacedReport> placed =
      placedInWorld(report, transforms_, tick->world_frame, tracker_.upright, params_.world_limit);
  const std::size_t too_old = list_.take(report, placed, thisMoment());
  if (too_old > 0) ledger_.count(counter_ + "out_of_order", too_old);
  if (report.ignored > 0) ledger_.count(counter_ + "ignored", report.ignored);
  if (report.unrotated > 0) ledger_.count(counter_ + "unrotated", report.unrotated);
  if (!report.unstamped) return;
  ledger_.refuse(counter_ + "unstamped",
                 Refusal(Code::clock, what_ + " has a stamp of 0; its time of arrival is used instead, so its tracks "
                                              "seem to be fresher than they are: let the tracker set header.stamp"));
}

/// Waits until tf knows the frames at their stamps, at most until the message is ~limits/max_sync_wait old.
void TrackSource::waitFor(const TrackReport& report, const std::string& world_frame) const {
  const auto deadline = report.arrival.steady + std::chrono::nanoseconds(std::llround(1e9 * params_.max_sync_wait));
  for (const auto& [frame, stamp] : framesOf(report)) {
    if (frame == world_frame) continue;
    while (!queue_.ended() && std::chrono::steady_clock::now() < deadline &&
           !transforms_.isKnown(world_frame, frame, stamp)) {
      std::this_thread::sleep_for(kLookAgain);
    }
  }
}

}  // namespace hgrid
