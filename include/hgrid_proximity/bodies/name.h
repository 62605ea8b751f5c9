// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

namespace hgrid {

/// Most bytes of the local part of a name.
inline constexpr std::size_t kLongestName = 128;

/// Checks one part of a name `source/local`: 1 to kLongestName bytes of UTF-8, no control characters;
/// a source has no slash either.
/// @param what  names the thing in the refusal, as in "obstacle name"
/// @throws Refusal bad_id
void checkSource(const std::string& source, const std::string& what);
void checkLocal(const std::string& local, const std::string& what);

/// `source/local`. The first slash splits: a source has none, a local part may have some.
std::string joined(const std::string& source, const std::string& local);

/// Whether a glob matches the whole name: `*` any run of bytes (slashes too), `?` one byte. Linear in
/// the length of the name times the pattern, whatever the pattern.
bool matches(const std::string& glob, const std::string& name);

/// Whether there is a name that both globs match. Linear in the product of their lengths.
bool canMatchTogether(const std::string& first, const std::string& second);

/// Whether `wide` matches every name that `narrow` matches. May say false where that is true, never the other way.
bool coversGlob(const std::string& wide, const std::string& narrow);

/// Whether any of the globs matches.
bool matchesAny(const std::vector<std::string>& globs, const std::string& name);

}  // namespace hgrid
