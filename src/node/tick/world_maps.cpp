// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Maps and clouds in the world: bodies whose cells are replaced while their structure stays.
#include <algorithm>
#include <cmath>

#include "hgrid_proximity/bodies/name.h"
#include "node/tick/world.h"

namespace hgrid {

bool World::isConnected(const std::string& frame) const {
  return frame == world_frame_ || intake_.buffer().canTransform(world_frame_, frame, ros::Time(0));
}

void World::setMap(const LoadedMap& map) {
  if (world_frame_.empty() && !findWorldFrame()) {
    throw Refusal(Code::not_ready, "map '" + map.params.name + "' cannot be placed yet: there is no world frame");
  }
  checkWithin(map.params.frame_from_map.translation(), params_.world_limit,
              "map '" + map.params.name + "': its position in its frame");
  Body body;
  body.name = joined("map", map.params.name);
  body.kind = BodyKind::map;
  body.frame = map.params.frame.empty() ? world_frame_ : map.params.frame;
  body.frame_from_body = map.params.frame_from_map;
  body.mobility = body.frame == world_frame_ ? Mobility::fixed : Mobility::moving;
  body.max_speed = lastMatch(params_.max_speed, body.name, params_.default_max_speed);
  applyPatterns(params_, body);
  const auto known = maps_.find(body.name);
  const bool same = known != maps_.end() && known->second.frame == body.frame &&
                    known->second.frame_from_body.matrix() == body.frame_from_body.matrix();
  if (known != maps_.end() && !same && !isConnected(body.frame)) {
    throw Refusal(Code::unknown_frame, "map '" + map.params.name + "': its frame '" + printable(body.frame) +
                                           "' is not connected to '" + world_frame_ + "'; the old map stays");
  }
  if (!map.cells || !map.cells->grid) {
    throw Refusal(Code::bad_geometry, "map '" + map.params.name + "' has no cells; a map must have them");
  }
  MapNews news = map_news_;
  news.noteAccepted(body.name, map);
  if (!same) {  // otherwise only its cells are others: the structure stays, and nobody starts again
    Change change = changeWithout([&](const std::string& other) { return other == body.name; });
    change.add(body.frame, body.name, body, body.frame_from_body);
    std::map<std::string, Body> loaded;
    loaded.emplace(body.name, body);
    exchange(std::move(change));
    maps_.erase(body.name);
    maps_.merge(loaded);
  }
  BodyId id;
  scene_.find(body.name, id);
  scene_.setCells(id, map.cells);  // cannot fail: the body is a map without shapes, and there are cells
  map_news_ = std::move(news);
  missing_.erase(body.name);
}

void World::clearMap(const std::string& name) {
  const std::string body = joined("map", name);
  if (!name.empty() && maps_.count(body) + missing_.count(body) == 0) {
    throw Refusal(Code::unknown_id, "there is no map '" + printable(name) + "'");
  }
  const auto chosen = [&](const std::string& other) {
    return name.empty() ? other.compare(0, 4, "map/") == 0 : other == body;
  };
  exchange(changeWithout(chosen));
  // Nothing below allocates.
  const auto eraseChosen = [&](auto& by_name) {
    for (auto one = by_name.begin(); one != by_name.end();)
      one = chosen(one->first) ? by_name.erase(one) : std::next(one);
  };
  for (const auto& map : maps_) {
    if (chosen(map.first)) map_news_.forget(map.first);
  }
  eraseChosen(missing_);  // nobody waits for them any more
  eraseChosen(maps_);
}

void World::setCloud(const LoadedCloud& loaded) {
  const std::string name = joined("cloud", loaded.name);
  LoadedCloud newest = loaded;
  auto known = clouds_.find(name);
  if (known == clouds_.end()) {
    Body body;
    body.name = name;
    body.kind = BodyKind::cloud;
    body.frame = world_frame_;
    body.max_speed = lastMatch(params_.max_speed, body.name, params_.default_max_speed);
    applyPatterns(params_, body);
    std::map<std::string, Cloud> added;
    added.emplace(name, Cloud{});
    added.begin()->second.body = scene_.add(std::move(body));
    clouds_.merge(added);
    missing_.erase(name);
    known = clouds_.find(name);
  }
  Cloud& cloud = known->second;
  scene_.setCells(cloud.body, newest.cells);
  // Nothing below allocates.
  const double gap = seconds(loaded.stamp - cloud.newest.stamp);
  if (cloud.newest.cells && gap > 0.0 && gap <= loaded.lifetime) {  // a longer one is an outage
    cloud.period = cloud.period > 0.0 ? 0.8 * cloud.period + 0.2 * std::min(gap, 2.0 * cloud.period) : gap;
  }
  if (loaded.stamp != cloud.newest.stamp) cloud.refused.clear();
  cloud.newest = std::move(newest);
}

Freshness World::judgeCloud(const Cloud& cloud, const Moment& now, double& age) const {
  const double ahead = seconds(cloud.newest.stamp - now.ros);
  age = watch_.simulated()
            ? std::abs(ahead)  // if /clock went back, cells that are too far ahead are gone as well
            : cloud.newest.latency + std::chrono::duration<double>(now.steady - cloud.newest.received).count();
  if (watch_.frozen()) return Freshness::frozen;
  if (age > cloud.newest.lifetime) return Freshness::lost;
  if (age > std::max(params_.stale_after, 1.5 * cloud.period)) return Freshness::stale;
  return age > std::max(params_.late_after, 1.5 * cloud.period) ? Freshness::late : Freshness::fresh;
}

/// What a cloud lacks that is lost: what it would see now. That can be anywhere, or, where the range of its sensor is
/// known, not beyond that range of where the sensor can be by now.
SourceGap World::gapOf(const BodyTrouble& trouble, const Cloud& cloud) const {
  const std::string& cloud_name = trouble.name;
  SourceGap gap{cloud_name, cloud_name,
                std::string(name(trouble.state)) + " " + cloud_name + ": what it saw is " + secondsText(trouble.age) +
                    " old" + (cloud.refused.empty() ? "" : "; since then: " + cloud.refused)};
  const double travelled = scene_.body(cloud.body).max_speed * trouble.age;
  if (cloud.newest.range > 0.0) gap.within = Sphere{cloud.newest.sensor, cloud.newest.range + travelled};
  return gap;
}

/// Clouds lie in the world frame: tf has placed their points already, each at its stamp.
void World::updateClouds(Time time, const Moment& now, Tick& tick, std::vector<SourceGap>& gaps) {
  for (const auto& named : clouds_) {
    const Cloud& cloud = named.second;
    BodyTrouble trouble{named.first, world_frame_, Freshness::fresh, 0.0, cloud.newest.stamp, Code::tf_timeout, {}};
    try {
      scene_.place(cloud.body, Pose(Eigen::Translation3d(cloud.newest.corner)), std::min(time, cloud.newest.stamp));
      trouble.state = judgeCloud(cloud, now, trouble.age);
      trouble.sentence = "cloud '" + named.first + "': the newest message that counts is " + secondsText(trouble.age) +
                         " old" + (trouble.state == Freshness::lost ? "; its cells have expired" : "") +
                         (cloud.refused.empty() ? "" : "; since then: " + cloud.refused);
      if (trouble.state >= Freshness::lost) gaps.push_back(gapOf(trouble, cloud));
      if (trouble.state == Freshness::lost && !cloud.refused.empty()) tick.not_ready.push_back(cloud.refused);
    } catch (const Refusal& refusal) {
      ledger_.refuse("pose.refused", refusal);
      trouble.state = Freshness::invalid;
      trouble.code = refusal.code();
      trouble.sentence = refusal.what();
    }
    scene_.setState(cloud.body, trouble.state, trouble.age);
    if (trouble.state != Freshness::fresh) tick.troubles.push_back(std::move(trouble));
  }
}

}  // namespace hgrid
