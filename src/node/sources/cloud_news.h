// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/bodies/source.h"
#include "node/sources/loaded_map.h"
#include "node/time/freshness.h"

namespace hgrid {

/// Decides from the messages of one cloud whether its cells can be trusted. Only one thread may use it.
class CloudNews {
 public:
  /// @param simulated  whether /clock drives ROS time. If so, ages are measured in ROS time, otherwise by the steady
  /// clock.
  explicit CloudNews(bool simulated) : simulated_(simulated) {}

  /// Stores the newest cells of the cloud. Does not throw.
  void noteAccepted(LoadedCloud loaded) noexcept;
  /// Notes that a message after the newest accepted one could not be used.
  void noteRefused(const std::string& sentence) { refused_ = sentence; }

  const LoadedCloud& newest() const { return newest_; }
  /// Returns why a message after the newest accepted one could not be used. Empty: no message was refused.
  const std::string& refused() const { return refused_; }
  /// Returns the smoothed time between the stamps of successive messages [s]. 0: not known yet.
  double period() const { return period_; }
  /// Returns the age of the newest message that was used [s].
  double ageOf(const Moment& now) const;
  /// Returns the state of the cells.
  /// @param limits  its lost_after is ignored: cells are LOST when they are older than their lifetime
  Freshness judge(const Moment& now, bool clock_frozen, AgeLimits limits) const;
  /// Says how old the cloud is, and why a later message was refused.
  std::string sentence(const std::string& body, Freshness state, double age) const;
  /// Returns the SourceGap that a cloud in this state leaves: things that the sensor would see now may be missing. They
  /// can be anywhere. If the range of the sensor is known, they are within that range of the places that the sensor can
  /// have reached by now.
  /// @param max_speed  [m/s] maximum speed of the sensor
  SourceGap gap(const std::string& body, Freshness state, double age, double max_speed) const;
  /// Returns the SourceGap before the lens of a sensor whose newest message has points that are too near to be seen.
  /// @param max_speed  [m/s] maximum speed of the sensor
  SourceGap gapBefore(const std::string& body, double age, double max_speed) const;

 private:
  std::string sinceThen() const { return refused_.empty() ? "" : "; a later message was refused: " + refused_; }

  bool simulated_;
  LoadedCloud newest_;
  double period_ = 0.0;
  std::string refused_;
};

}  // namespace hgrid
