// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/map_news.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

void MapNews::noteAccepted(const std::string& body, const LoadedMap& map) {
  News news;
  news.max_age = map.params.max_age;
  news.received = map.received;
  if (map.stamp.count() > 0) news.latency = std::max(0.0, seconds(map.received.ros - map.stamp));
  news_[body] = std::move(news);
}

void MapNews::noteRefused(const std::string& body, const std::string& sentence) {
  const auto known = news_.find(body);
  if (known != news_.end()) known->second.refused = sentence;
}

double MapNews::ageOf(const News& news, const Moment& now) const {
  // If a simulated clock went back, the age is not known. Then the map keeps the age that it had when it arrived.
  if (simulated_) return news.latency + std::max(0.0, seconds(now.ros - news.received.ros));
  return news.latency + std::chrono::duration<double>(now.steady - news.received.steady).count();
}

double MapNews::ageOf(const std::string& body, const Moment& now) const {
  const auto known = news_.find(body);
  return known == news_.end() ? 0.0 : ageOf(known->second, now);
}

std::vector<SourceGap> MapNews::gaps(const Moment& now) const {
  std::vector<SourceGap> gaps;
  for (const auto& named : news_) {
    const News& news = named.second;
    const double age = ageOf(news, now);
    if (!news.refused.empty()) {
      gaps.push_back({named.first, named.first,
                      "REFUSED '" + named.first + "': its newest message could not be used (" + news.refused +
                          "), so its cells may be out of date"});
    } else if (news.max_age > 0.0 && age > news.max_age) {
      gaps.push_back({named.first, named.first,
                      "OLD '" + named.first + "': its newest message is " + secondsText(age) +
                          " old; at most max_age, " + secondsText(news.max_age) + ", is allowed"});
    }
  }
  return gaps;
}

}  // namespace hgrid
