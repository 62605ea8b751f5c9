// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "map_measurement.h"
#include "measurement.h"

namespace hgrid {
namespace bench {

/// A measurement as a table for people, on standard output.
void print(const Measurement& measurement);
void print(const MapMeasurement& measurement);

/// All measurements as one JSON array of flat records, a record per part; the first says of which machine and commit.
/// @throws std::runtime_error if the file cannot be written
void writeJson(const std::string& file, const std::string& commit, const std::vector<Measurement>& measurements);

}  // namespace bench
}  // namespace hgrid
