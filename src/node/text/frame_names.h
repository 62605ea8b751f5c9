// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <string_view>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Returns the name of a tf frame without the leading slash that tf1 used and that tf2 does not allow.
inline std::string_view viewWithoutSlash(std::string_view frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}
inline std::string withoutSlash(const std::string& frame) { return std::string(viewWithoutSlash(frame)); }

/// Returns the name of the tf frame of a robot's link: the tf prefix, a slash and the link's name.
inline std::string prefixed(const std::string& prefix, const std::string& link) {
  const std::string clean = withoutSlash(prefix);
  return clean.empty() ? link : clean + "/" + link;
}

/// Returns the tf frame of what a sensor or tracker measured. @param what  begins the error sentence
/// @throws Refusal unknown_frame if there is none: only the publisher knows it
inline std::string frameOfData(const std::string& frame_id, const std::string& what) {
  std::string frame = withoutSlash(frame_id);
  if (!frame.empty()) return frame;
  throw Refusal(Code::unknown_frame, what +
                                         " has no frame_id, so nobody knows where it is; let its publisher set "
                                         "header.frame_id");
}

}  // namespace hgrid
