// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/UnknownReason.h>
#include <std_srvs/Trigger.h>

#include <string>
#include <type_traits>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"
#include "node/services/envelope/answer_tick.h"

namespace hgrid {

// These functions write the outcome of a request into its response. A response has one of these sets of fields:
// - `success` and `code`, and possibly `explanation` for a sentence;
// - an `answer`, which contains `success`, `code` and a verdict;
// - `success` and `message` (std_srvs/Trigger).
// In addition, a response may have the fields `world` and `header`.

template <class Response, class = void>
struct HasAnswer : std::false_type {};
template <class Response>
struct HasAnswer<Response, std::void_t<decltype(std::declval<Response&>().answer)>> : std::true_type {};

template <class Response, class = void>
struct HasExplanation : std::false_type {};
template <class Response>
struct HasExplanation<Response, std::void_t<decltype(std::declval<Response&>().explanation)>> : std::true_type {};

template <class Response, class = void>
struct HasWorld : std::false_type {};
template <class Response>
struct HasWorld<Response, std::void_t<decltype(std::declval<Response&>().world)>> : std::true_type {};

template <class Response, class = void>
struct HasHeader : std::false_type {};
template <class Response>
struct HasHeader<Response, std::void_t<decltype(std::declval<Response&>().header)>> : std::true_type {};

/// Writes into `header` and `world` which tick the response is made from.
template <class Response>
void writeTick(const AnswerTick& tick, Response& response) {
  if constexpr (HasHeader<Response>::value) {
    if (tick.get()) response.header = headerOf(*tick.get());
  }
  if constexpr (HasWorld<Response>::value) {
    if (tick.get()) {
      response.world = worldState(*tick.get(), tick.age());
    } else {
      response.world.worst_state = msg::BodyState::UNPLACED;
    }
  }
}

/// Writes that the request succeeded. The envelope calls this before the work, which may add a sentence to the code.
template <class Response>
void writeSuccess(Response& response) {
  if constexpr (HasAnswer<Response>::value) {
    writeSuccess(response.answer);
  } else {
    response.success = true;
    if constexpr (!std::is_same_v<Response, std_srvs::Trigger::Response>) response.code = toMsg(Code::ok, "");
  }
}

/// Writes why the request was refused, or which error inside the node stopped it.
/// @param is_fault  true: an error inside the node, although the request may be valid
template <class Response>
void writeRefusal(const Refusal& why, bool is_fault, Response& response) {
  if constexpr (HasAnswer<Response>::value) {
    response.answer = {};
    response.answer.code = toMsg(why.code(), why.what());
    response.answer.unknown_because = msg::UnknownReason::REFUSED;
    if (!is_fault) response.answer.summary = std::string("UNKNOWN, because the query was refused: ") + why.what();
  } else {
    response.success = false;
    if constexpr (std::is_same_v<Response, std_srvs::Trigger::Response>) {
      response.message = std::string(name(why.code())) + ": " + why.what();
    } else {
      response.code = toMsg(why.code(), why.what());
    }
    if constexpr (HasExplanation<Response>::value) {
      if (!is_fault) response.explanation = why.what();
    }
  }
}

}  // namespace hgrid
