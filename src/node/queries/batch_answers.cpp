// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/queries/batch_answers.h"

#include <cmath>
#include <utility>

#include "node/messages/body_names.h"

namespace hgrid {

BatchAnswers::BatchAnswers(const PreparedQuery& question, std::string outdated, double age_since,
                           msg::QueryBatch::Response& response)
    : question_(question),
      outdated_(std::move(outdated)),
      response_(response),
      writer_(question.snapshot, question.world_from_frame.inverse(), age_since) {}

void BatchAnswers::expect(std::size_t count, bool segments, bool bodies) {
  segments_ = segments;
  bodies_ = bodies;
  response_.codes.reserve(count);
  response_.verdicts.reserve(count);
  response_.unknown_because.reserve(count);
  response_.totals.reserve(count);
  response_.hits_end.reserve(count);
}

void BatchAnswers::add(const QueryAnswer& answer) {
  if (!answer.examined_all) {  // there may be nearer hits than those that were found
    response_.totals.push_back(0);
    addVerdict(
        Code::ok, Verdict::unknown, Unknown::budget,
        "max_time was over before the question was answered; raise max_time (at most 10 s) or ask fewer questions");
    return;
  }
  for (const QueryHit& hit : answer.hits) addHit(hit);
  response_.totals.push_back(static_cast<std::uint32_t>(answer.total));
  if (answer.verdict == Verdict::clear && !outdated_.empty()) {
    addVerdict(Code::ok, Verdict::unknown, Unknown::outdated, outdated_);
  } else {
    addVerdict(Code::ok, answer.verdict, answer.because, answer.reason);
  }
}

void BatchAnswers::refuse(Code code, std::string sentence) {
  response_.totals.push_back(0);
  addVerdict(code, Verdict::unknown, Unknown::refused, std::move(sentence));
}

void BatchAnswers::addVerdict(Code code, Verdict verdict, Unknown because, std::string sentence) {
  response_.hits_end.push_back(static_cast<std::uint32_t>(response_.body.size()));
  response_.codes.push_back(static_cast<std::uint16_t>(code));
  response_.verdicts.push_back(static_cast<std::uint8_t>(verdict));
  response_.unknown_because.push_back(static_cast<std::uint8_t>(because));
  if (sentence.empty() && response_.texts.empty()) return;
  response_.texts.resize(response_.codes.size());
  response_.texts.back() = std::move(sentence);
}

void BatchAnswers::addHit(const QueryHit& hit) {
  if (!std::isnan(hit.cell_edge) && response_.cell_edge.empty()) {
    response_.cell_edge.assign(response_.body.size(), QueryHit::kUnknown);
  }
  if (!std::isnan(hit.cell_edge) || !response_.cell_edge.empty()) response_.cell_edge.push_back(hit.cell_edge);
  response_.body.push_back(hit.body);
  response_.shape.push_back(hit.shape);
  response_.distance.push_back(hit.distance);
  response_.signed_distance.push_back(hit.signed_distance);
  response_.center_distance.push_back(hit.center_distance);
  if (segments_) response_.along.push_back(hit.along);
  response_.status.push_back(static_cast<std::uint8_t>(hit.status));
  response_.point.push_back(writer_.point(hit.point));
  if (bodies_) response_.own_point.push_back(writer_.point(hit.own_point));
  if (question_.scope.exact != nullptr) response_.normal.push_back(writer_.vector(hit.normal));
  response_.state.push_back(writer_.state(hit.body));
  response_.age.push_back(writer_.age(hit.body));
  response_.carried.push_back(writer_.isCarried(hit.body));
}

void BatchAnswers::finish() { nameBodies(question_.snapshot.structure().bodies, {&response_.body}, response_.names); }

}  // namespace hgrid
