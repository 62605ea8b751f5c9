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
  /// @param outdated   why no answer can be CLEAR; empty: answers can be
  /// @param age_since  [s] time since the snapshot was made
  BatchAnswers(const PreparedQuery& question, std::string outdated, double age_since,
               msg::QueryBatch::Response& response);

  /// Makes room for answers. @param segments, bodies  whether there are questions of these kinds
  void expect(std::size_t count, bool segments, bool bodies);
  /// Adds the answer to the next question.
  void add(const QueryAnswer& answer);
  /// Adds that the next question was refused.
  void refuse(Code code, std::string sentence);
  /// Completes the response after the last question.
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
