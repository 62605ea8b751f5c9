// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/bodies/source.h"
#include "node/sources/loaded_map.h"
#include "node/time/freshness.h"

namespace hgrid {

/// Judges whether the cells of one cloud can be trusted, by the messages that brought them. One thread.
class CloudNews {
 public:
  /// @param simulated  /clock drives ROS time, and ages are counted by it; otherwise they are counted by the steady
  /// clock
  explicit CloudNews(bool simulated) : simulated_(simulated) {}

  /// Takes in what the sensor has seen lately. Does not throw.
  void noteAccepted(LoadedCloud loaded) noexcept;
  /// A message since the newest accepted one could not be used.
  void noteRefused(const std::string& sentence) { refused_ = sentence; }

  const LoadedCloud& newest() const { return newest_; }
  /// Why a message since the newest accepted one could not be used; empty: all could.
  const std::string& refused() const { return refused_; }
  /// [s] between stamps, smoothed; 0: not known yet
  double period() const { return period_; }
  /// [s] Age of the newest message that counts.
  double ageOf(const Moment& now) const;
  /// @param limits  lost_after does not count: cells are LOST when they are older than their lifetime
  Freshness judge(const Moment& now, bool clock_frozen, AgeLimits limits) const;
  /// Says how old the cloud is, and what was refused since then.
  std::string sentence(const std::string& body, Freshness state, double age) const;
  /// What a cloud in this state lacks: what the sensor would see now. That can be anywhere, or, if the range of the
  /// sensor is known, within that range of where the sensor can be by now.
  /// @param max_speed  [m/s] of the sensor
  SourceGap gap(const std::string& body, Freshness state, double age, double max_speed) const;

 private:
  std::string sinceThen() const { return refused_.empty() ? "" : "; since then: " + refused_; }

  bool simulated_;
  LoadedCloud newest_;
  double period_ = 0.0;
  std::string refused_;
};

}  // namespace hgrid
