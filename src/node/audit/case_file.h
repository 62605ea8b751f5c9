// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <iosfwd>

#include "node/audit/audit_case.h"

namespace hgrid {

/// Writes a case as text: one line for each setting, transform, body, shape, pose, pair and query. Each line begins
/// with a word that says what it is. Strings are written with %xx for spaces and special bytes; an empty string is "%".
void writeCase(const AuditCase& audited, std::ostream& out);

/// Reads what writeCase() wrote. The audit of the result finds the same differences.
/// @throws Refusal parse that names the line
AuditCase readCase(std::istream& in);

}  // namespace hgrid
