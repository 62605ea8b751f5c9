// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Events.h>
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/Status.h>

#include <string>
#include <vector>

namespace hgrid {

namespace msg = ::hgrid_proximity;

namespace test {

// Functions that look up one value in a message.

/// Returns the entry of a body in ~status; null if the body is not listed.
const msg::BodyStatus* entryOf(const msg::Status& status, const std::string& body);
/// Returns the state of a body in ~status. A body that is not listed is FRESH.
int stateOf(const msg::Status& status, const std::string& body);
/// Returns the value of the counter `name` in ~status; 0 if ~status has no such counter.
std::uint64_t counter(const msg::Status& status, const std::string& name);
/// Returns the index of a pair in ~pairs; -1 if ~pairs does not contain it. `first` must be the name that sorts first.
int indexOf(const msg::Pairs& pairs, const std::string& first, const std::string& second);
/// Returns all pairs as "first|second", in the order of the message.
std::vector<std::string> namesOf(const msg::Pairs& pairs);
/// Returns all events as "7 BEGIN MOVED first|second" (number, kind, cause, names), in the order of the message.
std::vector<std::string> eventsOf(const msg::Events& events);

}  // namespace test
}  // namespace hgrid
