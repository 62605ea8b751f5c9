// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/verdict_markers.h"

#include <algorithm>
#include <string>

#include "node/markers/marker_parts.h"
#include "node/markers/pair_markers.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

constexpr std::size_t kMostReasonLines = 3, kLineLength = 60;  // a longer word has a longer line

std::size_t breaksIn(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Breaks a sentence into lines. RViz does not break lines.
std::string brokenIntoLines(const std::string& sentence) {
  std::string lines;
  std::size_t length = 0;
  for (std::size_t begin = 0; begin < sentence.size();) {
    const std::size_t end = std::min(sentence.find(' ', begin), sentence.size());
    if (length > 0 && length + 1 + end - begin > kLineLength) {
      if (breaksIn(lines) + 1 == kMostReasonLines) return lines + " ...";
      lines += '\n';
      length = 0;
    } else if (length > 0) {
      lines += ' ';
      ++length;
    }
    lines.append(sentence, begin, end - begin);
    length += end - begin;
    begin = end + 1;
  }
  return lines;
}

}  // namespace

std::vector<Marker> verdictMarkers(const Tick& tick, const NearPairs& near, const MarkerScale& scale) {
  const msg::WorldState world = worldState(tick, 0.0);
  const std::string pairs = std::to_string(near.count) + (near.count == 1 ? " near pair" : " near pairs");
  const std::string verdict = world.complete
                                  ? "COMPLETE: " + pairs
                                  : brokenIntoLines("NOT COMPLETE: " + (world.reasons.empty() ? "" : world.reasons[0]));
  const std::string list = listText(tick, near);
  // There is always room for a full list, so that the verdict does not jump when a pair comes or goes.
  const std::size_t verdict_lines = breaksIn(verdict) + 1, lines = verdict_lines + kMostListed;
  Eigen::Vector3d place = scale.world.center();
  place.z() = scale.world.max().z() + scale.text_height * (1.0 + 0.5 * static_cast<double>(lines));
  std::vector<Marker> texts =
      textsOf(tick, "verdict", 2, scale.text_height,
              {{place, verdict + std::string(kMostListed, '\n')},
               {place, std::string(verdict_lines, '\n') + list + std::string(kMostListed - 1 - breaksIn(list), '\n')}});
  if (!world.complete) texts[0].color = red();
  if (list.empty()) texts[1].action = Marker::DELETE;
  return texts;
}

}  // namespace hgrid
