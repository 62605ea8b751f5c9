// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>

#include <string>

namespace hgrid {

/// Reads a YAML document as a parameter value, as "rosparam load" does: unquoted true and false are booleans, and
/// unquoted numbers are integers or doubles.
/// @param what  name of the document for error sentences
/// @throws Refusal parse if the text is not YAML, or if it contains an alias, an empty value, the same key twice,
/// more than one document, or more than 32 levels of lists and dictionaries; the sentence names the line
XmlRpc::XmlRpcValue valueOfYaml(const std::string& text, const std::string& what);

}  // namespace hgrid
