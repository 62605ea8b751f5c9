// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hgrid {

/// What an audit compared, and the differences that it found.
struct AuditFindings {
  static constexpr std::size_t kMostSentences = 100;

  std::uint64_t poses = 0;               ///< number of poses that were computed again and compared
  std::uint64_t poses_skipped = 0;       ///< number of poses that could not be computed again from the record
  std::uint64_t pairs = 0;               ///< number of pairs of bodies that were compared
  std::uint64_t queries = 0;             ///< number of queries that were answered again
  std::uint64_t total = 0;               ///< number of differences
  std::vector<std::string> differences;  ///< one sentence for each of the first kMostSentences differences

  void add(std::string sentence) {
    if (++total <= kMostSentences) differences.push_back(std::move(sentence));
  }
};

}  // namespace hgrid
