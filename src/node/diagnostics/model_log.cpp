// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/diagnostics/model_log.h"

#include <ros/console.h>

#include <set>

namespace hgrid {

void ModelLog::log(const std::shared_ptr<const ModelReport>& report) {
  for (const std::string& line : next(report)) ROS_WARN("%s", line.c_str());
}

std::vector<std::string> ModelLog::next(const std::shared_ptr<const ModelReport>& report) {
  std::vector<std::string> lines;
  if (report == known_) return lines;
  std::set<std::string> known;
  if (known_) known.insert(known_->warnings.begin(), known_->warnings.end());
  std::size_t more = 0;
  for (const std::string& warning : report->warnings) {
    if (known.count(warning) != 0) continue;
    if (lines.size() < kMostLines) {
      lines.push_back(warning);
    } else {
      ++more;
    }
  }
  if (more > 0) lines.push_back("... and " + std::to_string(more) + " more warnings; see model_warnings of ~status");
  known_ = report;
  return lines;
}

}  // namespace hgrid
