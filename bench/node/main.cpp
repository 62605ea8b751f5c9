// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// node_testbench: how long the parts of the node's tick take. Started by bench/node/run.

#include <ros/init.h>
#include <ros/spinner.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "measurement.h"
#include "report.h"

int main(int argc, char** argv) {
  using namespace hgrid::bench;
  ros::init(argc, argv, "node_testbench");
  std::string json, commit = "unknown";
  double duration = 10.0;  // [s]
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--quick") duration = 4.0;
    if (option == "--json" && i + 1 < argc) json = argv[++i];
    if (option == "--commit" && i + 1 < argc) commit = argv[++i];
  }
  try {
    ros::AsyncSpinner spinner(1);
    spinner.start();
    std::vector<Measurement> measurements;
    std::vector<Workload> workloads{robots(32, 31, 100.0), freeBodies(1000, 100.0), freeBodies(10000, 10.0),
                                    robots(32, 31, 100.0)};
    workloads.back().title += ", distances measured";
    workloads.back().distances = true;
    for (Workload& workload : realRobots(100.0)) workloads.push_back(std::move(workload));
    if (workloads.size() == 4) std::printf("without real robots: their descriptions are not at hand\n");
    for (const Workload& workload : workloads) {
      measurements.push_back(measure(workload, duration));
      print(measurements.back());
    }
    if (!json.empty()) writeJson(json, commit, measurements);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "node_testbench: %s\n", error.what());
    return 1;
  }
  return 0;
}
