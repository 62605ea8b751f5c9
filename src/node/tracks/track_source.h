// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "node/health/ledger.h"
#include "node/health/start_grace.h"
#include "node/params/params.h"
#include "node/tf/transform_lookup.h"
#include "node/threads/immediate_callbacks.h"
#include "node/tick/tick.h"
#include "node/tracks/track_list.h"
#include "node/tracks/track_queue.h"

namespace hgrid {

/// Reads the messages of one tracker on a separate thread, and keeps its tracks.
///
/// Ticks and queries do not wait for that thread. Counters: "track/<name>.received" is the sum of
/// "track/<name>.applied", "track/<name>.refused.<CODE>", "track/<name>.dropped.LIMIT" and of the messages that still
/// wait.
class TrackSource {
 public:
  /// Functions that receive the results. TrackSource calls them on its own thread.
  struct Sink {
    std::function<void(const std::vector<std::string>& frames)> follow;  ///< names the frames of the newest poses
    std::function<void(std::shared_ptr<const TrackSet>)> put;            ///< puts all tracks into the world
  };

  /// @param node       the name of the topic is resolved in its namespace
  /// @param max_speed  [m/s] largest speed of a track
  /// All references must outlive this object.
  TrackSource(ros::NodeHandle node, const TrackerParams& tracker, double max_speed, const Params& params,
              const TransformLookup& transforms, std::function<std::shared_ptr<const Tick>()> newest, Sink sink,
              Ledger& ledger);
  ~TrackSource();
  TrackSource(const TrackSource&) = delete;
  TrackSource& operator=(const TrackSource&) = delete;

 private:
  void subscribe(ros::NodeHandle& node);
  void onMessage(const ros::MessageEvent<const MessageBytes>& event);
  void run();
  void handle(const ReceivedTracks& received);
  void take(const ReceivedTracks& received);
  void waitFor(const TrackReport& report, const std::string& world_frame) const;
  void put() { sink_.put(std::make_shared<const TrackSet>(list_.set())); }

  TrackerParams tracker_;
  std::string what_;     // names the tracker in error sentences
  std::string counter_;  // prefix of the names of its counters
  std::string failed_;   // name of the counter of exceptions on its thread
  const Params& params_;
  const TransformLookup& transforms_;
  std::function<std::shared_ptr<const Tick>()> newest_;
  Sink sink_;
  Ledger& ledger_;
  const StartGrace grace_;
  TrackQueue queue_;
  TrackList list_;                   // only the thread uses it
  std::vector<std::string> frames_;  // only the thread uses it: the frames of the newest poses
  ImmediateCallbacks immediately_;
  ros::Subscriber subscriber_;
  std::thread thread_;  // declared last, because it uses the members above
};

}  // namespace hgrid
