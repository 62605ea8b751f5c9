// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/loading.h"

#include <utility>

#include "node/loading/missing_note.h"

namespace hgrid {

Loading::Loading(ros::NodeHandle node, const ros::NodeHandle& private_node, Commons& commons,
                 const TransformLookup& transforms, NewestTick newest, PrepareRobots prepare_robots, TickJobs& jobs,
                 const RobotModels& robots, const StoredMaps& stored_maps, std::function<bool()> is_ending)
    : node_(std::move(node)),
      commons_(commons),
      transforms_(transforms),
      newest_(std::move(newest)),
      jobs_(jobs),
      is_ending_(std::move(is_ending)),
      self_shapes_(commons.settings.params, transforms, newest_),
      robot_source_(private_node, commons.settings.params, commons.narrow_phase, is_ending_),
      map_source_(commons.settings.params, self_shapes_, commons.narrow_phase, commons.ledger),
      robots_(robot_source_, commons.settings.params, robots, std::move(prepare_robots), jobs, commons.health),
      maps_(node_, commons.settings.params, map_source_, stored_maps, jobs, commons.ledger) {}

void Loading::startClouds() {
  for (const CloudParams& cloud : commons_.settings.params.clouds) startCloud(cloud);
}

void Loading::startCloud(const CloudParams& cloud) {
  CloudSource::Sink sink;
  sink.put = [this](const LoadedCloud& loaded) { jobs_.run([loaded](World& world) { world.setCloud(loaded); }); };
  sink.follow = [this, name = cloud.name](const std::string& frame) {
    const SourceId source = SourceId::ofCloud(name);
    jobs_.add("frames of " + source.name, [source, frame](World& world) { world.setDataFrames(source, {frame}); });
  };
  sink.miss = [this, source = SourceId::ofCloud(cloud.name)](const std::string& sentence) {
    noteMissing(jobs_, source, sentence);
  };
  clouds_.push_back(std::make_unique<CloudSource>(node_, cloud, commons_.settings.params, self_shapes_, transforms_,
                                                  commons_.narrow_phase, newest_, sink, commons_.ledger));
}

void Loading::retry(RetrySchedule::Time now) {
  if (robots_.takeNewlyMissing()) schedule_ = RetrySchedule();
  if ((!robots_.hasMissing() && !maps_.hasMissing()) || !schedule_.isDue(now)) return;
  schedule_.noteTry(now);
  robots_.loadMissing();
  maps_.loadMissing();
}

}  // namespace hgrid
