// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// Paddings [m] of links that were set at run time, by the name of the link with or without its robot. A name without a
/// robot means the links of all robots that have this name.
using LinkPaddings = std::map<std::string, double>;

/// Returns the padding of a link at run time: the largest one whose name fits; 0: there is none.
inline double paddingOf(const std::string& link, const LinkPaddings& paddings) {
  double padding = 0.0;
  for (const std::string& name : {link, link.substr(link.find('/') + 1)}) {
    const auto found = paddings.find(name);
    if (found != paddings.end() && found->second > padding) padding = found->second;
  }
  return padding;
}

/// Returns the link with the paddings of its shapes raised to its padding at run time.
inline Body padded(Body link, const LinkPaddings& paddings) {
  const double padding = paddings.empty() ? 0.0 : paddingOf(link.name, paddings);
  for (BodyShape& shape : link.shapes) {
    if (shape.padding < padding) shape.padding = padding;
  }
  return link;
}

}  // namespace hgrid
