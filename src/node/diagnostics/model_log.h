// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "node/robots/model_report.h"

namespace hgrid {

/// Logs the first new warnings of the ModelReport whenever a robot was loaded: oddities of robot descriptions, and
/// patterns in the parameters that match no body. One thread may use it.
class ModelLog {
 public:
  static constexpr std::size_t kMostLines = 5;  ///< largest number of warnings that are logged at once

  /// Logs the lines that next() returns. Call this for every tick.
  void log(const std::shared_ptr<const ModelReport>& report);
  /// Returns the lines to log: the first kMostLines warnings that the last report did not have, and then how many more
  /// there are. Returns no line if the report is the same as in the last call.
  std::vector<std::string> next(const std::shared_ptr<const ModelReport>& report);

 private:
  std::shared_ptr<const ModelReport> known_;
};

}  // namespace hgrid
