// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// What the program is asked to do. The lists narrow a run down; empty: everything (sizes and moving: the usual ones).
struct Options {
  bool quick = false;
  std::string json;             ///< file for the figures; empty: none
  std::string commit, command;  ///< what is measured and how, for the figures file
  std::vector<std::string> parts, workloads, peers, movers;
  std::vector<std::size_t> sizes;
  /// Of each kind, asked in turn; a multiple of 1,000. So many that no processor learns their branches by heart, as it
  /// does of 1,000 that come again and again.
  std::size_t questions = 100000;
  std::vector<double> moving;

  bool part(const std::string& name) const;
  bool workload(const std::string& name) const;
  /// The workloads of boxes that were asked for; `usual` if none was.
  std::vector<std::string> boxWorkloads(const std::vector<std::string>& usual) const;
  bool peer(const std::string& name) const;
};

/// @throws std::invalid_argument naming what is not understood.
Options parsed(int count, const char* const* arguments);

/// How to call the program.
extern const char* const kUsage;

}  // namespace bench
}  // namespace hgrid
