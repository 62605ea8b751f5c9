// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tinyxml2.h>

#include <string>

#include "hgrid_proximity/adapters/urdf.h"

namespace hgrid {

/// Checks the text like checkXml() and parses the text into `document`, which then has a root element.
/// @param root  the name that the root element must have
/// @throws Refusal in the same cases as checkXml()
void parseXml(const std::string& xml, const DescriptionLimits& limits, const std::string& what, const char* root,
              tinyxml2::XMLDocument& document);

}  // namespace hgrid
