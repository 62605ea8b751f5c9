// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// node_testbench measures how long the parts of the node's tick take. bench/node/run starts it.

#include <ros/init.h>
#include <ros/spinner.h>

#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "batch_measurement.h"
#include "change_measurement.h"
#include "control_measurement.h"
#include "map_measurement.h"
#include "measurement.h"
#include "report.h"

namespace hgrid {
namespace bench {
namespace {

std::vector<Workload> movingWorlds() {
  std::vector<Workload> worlds{robots(32, 31, 100.0),         freeBodies(1000, 100.0),        freeBodies(10000, 10.0),
                               freeBodies(10000, 100, 100.0), freeBodiesByPoses(10000, 50.0), robots(32, 31, 100.0)};
  worlds.back().title += ", distances measured";
  worlds.back().distances = true;
  for (Workload& world : realRobots(100.0)) worlds.push_back(std::move(world));
  if (worlds.size() == 6) std::printf("without real robots: their descriptions were not found\n");
  return worlds;
}

}  // namespace
}  // namespace bench
}  // namespace hgrid

int main(int argc, char** argv) {
  using namespace hgrid::bench;
  ros::init(argc, argv, "node_testbench");
  std::string json, commit = "unknown";
  double duration = 10.0;  // [s] measured time per world
  std::string only;        // "" (everything), "worlds", "controls", "maps", "changes", "batches" or "guard"
  std::string title;       // part of the titles of the worlds that are measured
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--quick") duration = 4.0;
    for (const char* part : {"worlds", "controls", "maps", "changes", "batches", "guard"}) {
      if (option == std::string("--") + part) only = part;
    }
    if (option == "--world" && i + 1 < argc) only = "worlds", title = argv[++i];
    if (option == "--json" && i + 1 < argc) json = argv[++i];
    if (option == "--commit" && i + 1 < argc) commit = argv[++i];
  }
  try {
    ros::AsyncSpinner spinner(1);
    spinner.start();
    std::vector<Measurement> measurements;
    if (only.empty() || only == "worlds") {
      for (const Workload& world : movingWorlds()) {
        if (world.title.find(title) == std::string::npos) continue;
        measurements.push_back(measure(world, duration));
        print(measurements.back());
      }
    }
    std::optional<ControlMeasurement> controls;
    if (only.empty() || only == "controls") {
      controls = measureControls(robots(32, 31, 100.0), duration);
      print(*controls);
    }
    if (only.empty() || only == "maps") {
      const MapMeasurement maps = measureMaps(duration);
      print(maps);
      measurements.push_back(maps.resting);
      measurements.push_back(maps.replaced);
    }
    std::optional<ChangeMeasurement> changes;
    if (only.empty() || only == "changes") {
      changes = measureChanges();
      print(*changes);
    }
    std::vector<BatchMeasurement> batches;
    if (only.empty() || only == "batches") {
      batches = measureBatches(duration);
      for (const BatchMeasurement& batch : batches) print(batch);
    }
    std::optional<GuardMeasurement> guard;
    if (only.empty() || only == "guard") {
      guard = measureGuard(duration);
      if (guard) print(*guard);
    }
    if (!json.empty()) writeJson(json, commit, measurements, controls, changes, batches, guard);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "node_testbench: %s\n", error.what());
    return 1;
  }
  return 0;
}
