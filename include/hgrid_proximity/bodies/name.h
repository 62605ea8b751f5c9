// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

namespace hgrid {

/// Largest length of each part of a name `source/local` [bytes].
inline constexpr std::size_t kLongestName = 128;

///@{
/// Checks one part of a name `source/local`. Each part must have 1 to kLongestName bytes of UTF-8 without control
/// characters. A source must not contain a slash.
/// @param what  name of the object for the error sentence, such as "obstacle name"
/// @throws Refusal bad_id if the part breaks one of these rules
void checkSource(const std::string& source, const std::string& what);
void checkLocal(const std::string& local, const std::string& what);
///@}

/// Returns the name `source/local`. The first slash in the name separates the two parts, because only the local part
/// may contain slashes.
std::string joined(const std::string& source, const std::string& local);

/// Whether a glob matches the whole name. `*` matches any number of bytes, including slashes; no other
/// character has a special meaning. The running time is at most proportional to the product of both lengths.
bool matches(const std::string& glob, const std::string& name);

/// Whether there is a name that both globs match. The running time is proportional to the product of their lengths.
bool canMatchTogether(const std::string& first, const std::string& second);

/// Whether `wide` surely matches every name that `narrow` matches. If the function cannot decide this, it returns
/// false.
bool coversGlob(const std::string& wide, const std::string& narrow);

/// Whether any of the globs matches the name.
bool matchesAny(const std::vector<std::string>& globs, const std::string& name);

}  // namespace hgrid
