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
  bool only_maps = false;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--quick") duration = 4.0;
    if (option == "--maps") only_maps = true;
    if (option == "--json" && i + 1 < argc) json = argv[++i];
    if (option == "--commit" && i + 1 < argc) commit = argv[++i];
  }
  try {
    ros::AsyncSpinner spinner(1);
    spinner.start();
    std::vector<Measurement> measurements;
    for (const Workload& world : only_maps ? std::vector<Workload>() : movingWorlds()) {
      measurements.push_back(measure(world, duration));
      print(measurements.back());
    }
    std::optional<ControlMeasurement> controls;
    if (!only_maps) {
      controls = measureControls(robots(32, 31, 100.0), duration);
      print(*controls);
    }
    const MapMeasurement maps = measureMaps(duration);
    print(maps);
    measurements.push_back(maps.resting);
    measurements.push_back(maps.replaced);
    if (!json.empty()) writeJson(json, commit, measurements, controls);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "node_testbench: %s\n", error.what());
    return 1;
  }
  return 0;
}
