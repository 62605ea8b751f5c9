// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "batch_measurement.h"
#include "change_measurement.h"
#include "control_measurement.h"
#include "guard_measurement.h"
#include "map_measurement.h"
#include "measurement.h"

namespace hgrid {
namespace bench {

/// Prints a measurement as a table to the standard output.
void print(const Measurement& measurement);
void print(const MapMeasurement& measurement);
void print(const ControlMeasurement& measurement);
void print(const ChangeMeasurement& measurement);
void print(const BatchMeasurement& measurement);
void print(const GuardMeasurement& measurement);

/// Writes all measurements as one JSON array of flat records, one record per part of a measurement. The first record
/// names the machine and the commit.
/// @throws std::runtime_error if the file cannot be written
void writeJson(const std::string& file, const std::string& commit, const std::vector<Measurement>& measurements,
               const std::optional<ControlMeasurement>& controls, const std::optional<ChangeMeasurement>& changes,
               const std::vector<BatchMeasurement>& batches, const std::optional<GuardMeasurement>& guard);

}  // namespace bench
}  // namespace hgrid
