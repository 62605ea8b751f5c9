// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/queries/quick_query.h"

#include "node/text/frame_names.h"

namespace hgrid {

bool mayBeQuick(const QueryOptions& options, const Tick& tick) {
  const Snapshot& snapshot = *tick.snapshot;
  const Structure& structure = snapshot.structure();
  const std::string_view frame = viewWithoutSlash(options.frame);
  const bool in_world = frame.empty() || frame == tick.world_frame;  // chains of frames can be long
  const bool about_all = options.include.empty() && options.exclude.empty() && !options.respect_allowed;
  return in_world && about_all && !options.exact && structure.maps.empty() &&
         structure.body_of_proxy.size() <= kQuickBoxes && structure.filter.rules().size() <= kQuickRules &&
         snapshot.gaps().size() <= kQuickGaps;
}

}  // namespace hgrid
