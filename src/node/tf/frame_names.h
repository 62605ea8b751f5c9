// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

namespace hgrid {

/// A tf frame's name as tf2 wants it: tf1's leading slash removed.
inline std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

/// The frame of a robot's link under a tf prefix.
inline std::string prefixed(const std::string& prefix, const std::string& link) {
  const std::string clean = withoutSlash(prefix);
  return clean.empty() ? link : clean + "/" + link;
}

}  // namespace hgrid
