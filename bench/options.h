// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// The command line options. Each list selects what to run. An empty list selects everything. But if `sizes` or
/// `moving` is empty, default values are used.
struct Options {
  bool quick = false;
  std::string json;             ///< file to which the results are written; empty: no file
  std::string commit, command;  ///< Git commit and command line; they are written to the file
  std::vector<std::string> parts, workloads, peers, movers;
  std::vector<std::size_t> sizes;  ///< numbers of boxes; of the part exactness: of pairs in each world
  /// Number of different queries of each kind, a multiple of 1,000. If fewer queries were repeated all the time, the
  /// branch predictor of the processor would learn them, and the times would be too short.
  std::size_t questions = 100000;
  std::string worlds;          ///< folder of recorded worlds; empty: they are left out
  double limit = 0.0;          ///< [s] a peer that finds no pairs for this long is left out; 0: the usual time
  std::vector<double> moving;  ///< fractions of the boxes that move in a frame (time step)

  /// Returns whether this part of the benchmark is selected.
  bool part(const std::string& name) const;
  bool workload(const std::string& name) const;
  /// Returns the selected workloads that consist of boxes; `usual` if no workload is selected.
  std::vector<std::string> boxWorkloads(const std::vector<std::string>& usual) const;
  bool peer(const std::string& name) const;
};

/// Parses the command line. @throws std::invalid_argument with the unknown option or the wrong value
Options parsed(int count, const char* const* arguments);

/// The usage text of the program.
extern const char* const kUsage;

}  // namespace bench
}  // namespace hgrid
