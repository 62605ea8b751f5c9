// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/measure/sample.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {

/// The correct hits of the first kFirst queries of a set, found by testing every box.
///
/// A query is not judged if float rounding may decide whether a box is a hit, see doubtOf(). Box queries need no
/// rounding, so all of them are judged.
class Judge {
 public:
  static constexpr std::size_t kFirst = 1000;

  Judge(QueryKind kind, const QuerySet& queries, const std::vector<Aabb>& boxes);

  /// Returns the number of queries that were tested. They are the first ones of the set.
  std::size_t size() const { return judged_.size(); }
  /// Returns whether the query is judged, which means that its hits are compared.
  bool judges(std::size_t query) const { return judged_[query]; }
  std::size_t judgedCount() const { return judged_count_; }
  /// Returns the number of correct hits of all judged queries. checksum() returns their checksum.
  std::uint64_t count() const { return count_; }
  std::uint64_t checksum() const { return checksum_.value(); }

  /// Returns a number that represents one hit of one query in the checksum.
  static std::uint64_t hit(std::size_t query, ProxyId id) { return std::uint64_t{query} << 32 | id; }

 private:
  std::vector<bool> judged_;
  std::size_t judged_count_ = 0;
  std::uint64_t count_ = 0;
  Checksum checksum_;
};

}  // namespace bench
}  // namespace hgrid
