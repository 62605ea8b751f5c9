// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "measurement.h"
#include "workload.h"

namespace hgrid {
namespace bench {

/// Figures of the node beside those of controls, which only use ROS. Each pair is measured with the same messages.
struct ControlMeasurement {
  std::string title;
  std::size_t transforms = 0;    ///< number of transforms of one cycle of /tf
  Spread relay;                  ///< from the stamp of a cycle to the arrival of its last message, relayed by a control
  double ignore_percent = 0.0;   ///< processor time of a control that ignores /tf, in percent of one processor
  double receive_percent = 0.0;  ///< the same of the node while it makes one tick per second
  Spread empty_service, sphere;  ///< round trips over a persistent connection: a control's empty service, ~query_sphere
};

/// Measures each of the figures for `duration` [s].
/// @throws std::runtime_error if a program does not start
ControlMeasurement measureControls(const Workload& workload, double duration);

}  // namespace bench
}  // namespace hgrid
