// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// The command line options. Each list selects what to run. An empty list selects everything; empty lists `sizes` and
/// `moving` select the default values.
struct Options {
  bool quick = false;
  std::string json;             ///< file to write the figures to; empty: no file
  std::string commit, command;  ///< Git commit and command line, for the figures file
  std::vector<std::string> parts, workloads, peers, movers;
  std::vector<std::size_t> sizes;
  /// Number of different queries of each kind, a multiple of 1,000. They are asked in turn. If only 1,000 queries were
  /// repeated, the branch predictor of the processor would learn them, and the times would be too short.
  std::size_t questions = 100000;
  std::vector<double> moving;  ///< fractions of the boxes that move in a frame

  /// Whether this part of the benchmark is selected.
  bool part(const std::string& name) const;
  bool workload(const std::string& name) const;
  /// Returns the selected workloads that consist of boxes; `usual` if no workload is selected.
  std::vector<std::string> boxWorkloads(const std::vector<std::string>& usual) const;
  bool peer(const std::string& name) const;
};

/// Parses the command line. @throws std::invalid_argument that names an unknown option or a wrong value.
Options parsed(int count, const char* const* arguments);

/// The usage text of the program.
extern const char* const kUsage;

}  // namespace bench
}  // namespace hgrid
