// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <iosfwd>

#include "node/audit/audit_case.h"

namespace hgrid {

/// Writes a case as text. Each line begins with a word that says what the line contains, for example a transform, a
/// body, a pose or a pair. Each string begins with %. In strings, %xx stands for a space or a special byte.
void writeCase(const AuditCase& audited, std::ostream& out);

/// Reads a case that writeCase() wrote. An audit of the result finds the same differences as an audit of the original.
/// @throws Refusal parse if the text is not valid
AuditCase readCase(std::istream& in);

}  // namespace hgrid
