// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/cloud_bodies.h"

#include <algorithm>
#include <utility>

#include "node/params/body_params.h"

namespace hgrid {

CloudBodies::CloudBodies(const Params& params, bool simulated, Scene& scene, Ledger& ledger)
    : params_(params), simulated_(simulated), scene_(scene), ledger_(ledger) {}

CloudBodies::Cloud& CloudBodies::add(const SourceId& cloud, const std::string& world_frame) {
  Body body;
  body.name = cloud.name;
  body.kind = BodyKind::cloud;
  body.frame = world_frame;
  applyMaxSpeed(params_, body);
  applyPatterns(params_, body);
  std::map<SourceId, Cloud> added;
  Cloud& result = added.emplace(cloud, Cloud{{}, CloudNews(simulated_)}).first->second;
  result.body = scene_.add(std::move(body));
  clouds_.merge(added);  // moves the entry without allocating, so `result` stays valid
  return result;
}

void CloudBodies::set(const SourceId& cloud, const LoadedCloud& loaded, const std::string& world_frame) {
  LoadedCloud newest = loaded;
  const auto known = clouds_.find(cloud);
  Cloud& one = known == clouds_.end() ? add(cloud, world_frame) : known->second;
  scene_.setCells(one.body, newest.cells);
  // The code below does not allocate, so it cannot fail.
  one.news.noteAccepted(std::move(newest));
}

bool CloudBodies::noteRefused(const SourceId& cloud, const std::string& sentence) {
  const auto known = clouds_.find(cloud);
  if (known == clouds_.end()) return false;
  known->second.news.noteRefused(sentence);
  return true;
}

/// Places each cloud and sets its state. The cells of a cloud are already in the world frame, because tf placed the
/// points of each message at its stamp.
void CloudBodies::update(const Moment& now, bool clock_frozen, Tick& tick, std::vector<SourceGap>& gaps) {
  const AgeLimits limits{params_.late_after, params_.stale_after, params_.lost_after};
  for (const auto& [source, cloud] : clouds_) {
    const LoadedCloud& newest = cloud.news.newest();
    const std::string& refused = cloud.news.refused();
    BodyTrouble trouble{source.name, tick.world_frame, Freshness::fresh, 0.0, newest.stamp, Code::tf_timeout, {}};
    try {
      scene_.place(cloud.body, Pose(Eigen::Translation3d(newest.corner)), std::min(now.ros, newest.stamp));
      trouble.age = cloud.news.ageOf(now);
      trouble.state = cloud.news.judge(now, clock_frozen, limits);
      trouble.sentence = cloud.news.sentence(source.name, trouble.state, trouble.age);
      if (trouble.state >= Freshness::lost) {
        gaps.push_back(cloud.news.gap(source.name, trouble.state, trouble.age, scene_.body(cloud.body).max_speed));
      }
      if (newest.too_near > 0) {
        gaps.push_back(cloud.news.gapBefore(source.name, trouble.age, scene_.body(cloud.body).max_speed));
      }
      if (trouble.state == Freshness::lost && !refused.empty()) tick.not_ready.push_back(refused);
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
