// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/cloud_news.h"

#include <algorithm>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/time/data_time.h"

namespace hgrid {

void CloudNews::noteAccepted(LoadedCloud loaded) noexcept {
  const double gap = seconds(loaded.stamp - newest_.stamp);
  if (newest_.cells && gap > 0.0 && gap <= loaded.lifetime) {  // a longer gap counts as an outage
    period_ = period_ > 0.0 ? 0.8 * period_ + 0.2 * std::min(gap, 2.0 * period_) : gap;
  }
  if (loaded.stamp != newest_.stamp) refused_.clear();
  newest_ = std::move(loaded);
}

double CloudNews::ageOf(const Moment& now) const {
  DataTime newest;
  newest.stamp = newest_.stamp;
  newest.latency = newest_.latency;
  newest.received = newest_.received;
  return newest.age(now, simulated_);
}

Freshness CloudNews::judge(const Moment& now, bool clock_frozen, AgeLimits limits) const {
  limits.lost_after = newest_.lifetime;
  return judgeCloud(ageOf(now), period_, clock_frozen, limits);
}

std::string CloudNews::sentence(const std::string& body, Freshness state, double age) const {
  return "cloud '" + body + "': its newest usable message is " + secondsText(age) + " old" +
         (state == Freshness::lost ? "; its cells have expired" : "") + sinceThen();
}

SourceGap CloudNews::gap(const std::string& body, Freshness state, double age, double max_speed) const {
  SourceGap gap{
      body, body,
      std::string(name(state)) + " " + body + ": its newest points are " + secondsText(age) + " old" + sinceThen()};
  if (newest_.range > 0.0) gap.within = Sphere{newest_.sensor, newest_.range + max_speed * age};
  return gap;
}

SourceGap CloudNews::gapBefore(const std::string& body, double age, double max_speed) const {
  return {body, body,
          "TOO_NEAR " + body + ": " + std::to_string(newest_.too_near) +
              " points of its newest message are -inf, so something nearer than the sensor can see may be within " +
              text(newest_.blind.radius) + " m (blind_range) of it",
          Sphere{newest_.blind.center, newest_.blind.radius + max_speed * age}};
}

}  // namespace hgrid
