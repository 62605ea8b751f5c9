// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/QueryBatch.h>

#include <string>

#include "node/messages/hit_messages.h"
#include "node/queries/query_request.h"

namespace hgrid {

/// Writes the answers to the questions of ~query_batch into its response.
class BatchAnswers {
 public:
  /// @param question   what all questions have in common; must outlive this object
  /// @param outdated   sentence that replaces each CLEAR by UNKNOWN; empty: the tick is recent enough
  /// @param age_since  [s] time since the snapshot was made
  BatchAnswers(const PreparedQuery& question, std::string outdated, double age_since,
               msg::QueryBatch::Response& response);

  /// Reserves memory for `count` answers. Must be called before add().
  /// @param segments, bodies  whether the batch asks about segments, about bodies; if not, `along`, `own_point` stay
  /// empty
  void expect(std::size_t count, bool segments, bool bodies);
  /// Adds the answer to the next question.
  void add(const QueryAnswer& answer);
  /// Adds that the next question was refused.
  void refuse(Code code, std::string sentence);
  /// Fills `names`, and makes `body` refer to it. Call this once, after the last question.
  void finish();

 private:
  void addVerdict(Code code, Verdict verdict, Unknown because, std::string sentence);
  void addHit(const QueryHit& hit);

  const PreparedQuery& question_;
  const std::string outdated_;
  msg::QueryBatch::Response& response_;
  const HitWriter writer_;
  bool segments_ = false, bodies_ = false;
};

}  // namespace hgrid
