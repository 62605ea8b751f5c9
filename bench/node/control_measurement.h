// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "measurement.h"
#include "workload.h"

namespace hgrid {
namespace bench {

/// Processor times of two programs that receive the same messages of /tf at the same time, in percent of one processor.
struct Receiving {
  double node = 0.0;     ///< the node while it makes one tick per second
  double control = 0.0;  ///< a control with an empty callback
};

/// How long calls of a service take.
struct ServiceTimes {
  Spread all;
  std::vector<double> p99_of_turns;  ///< [ms] 99th percentile of each of several spans of time, sorted
};

/// The difference of the 99th percentiles of two services, with its 95 % confidence interval. A call can wait some
/// milliseconds for a processor, so a difference without its interval says little.
struct Difference {
  double p99 = 0.0, low = 0.0, high = 0.0;  ///< [ms]
};

/// Figures of the node beside those of controls, which only use ROS. Each pair is measured with the same messages.
struct ControlMeasurement {
  std::string title;
  std::size_t transforms = 0;  ///< number of transforms of one cycle of /tf
  Spread relay;                ///< from the stamp of a cycle to the arrival of its last message, relayed by a control
  Receiving idle;              ///< with one cycle of /tf per second
  Receiving receiving;        ///< with the /tf of the workload: of several starts, the one with the median of timesOf()
  std::vector<double> times;  ///< timesOf() of each of these starts, sorted
  // Round trips over persistent connections:
  ServiceTimes empty_service;            ///< an empty service, which a control offers
  ServiceTimes empty_service_beside_tf;  ///< an empty service of a control that also receives /tf
  ServiceTimes sphere;                   ///< the service ~query_sphere of the node
  Difference above_empty;                ///< p99 of ~query_sphere minus p99 of the empty service
  Difference above_empty_beside_tf;      ///< the same for the control that also receives /tf

  /// Returns the processor time of the node divided by that of the control, each without its time at one cycle of /tf
  /// per second.
  double timesOf(const Receiving& both) const { return (both.node - idle.node) / (both.control - idle.control); }
};

/// Measures each of the figures for `duration` [s].
/// @throws std::runtime_error if a program does not start
ControlMeasurement measureControls(const Workload& workload, double duration);

}  // namespace bench
}  // namespace hgrid
