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

// What messages say of one thing.

/// A body's entry in ~status; null if it is not listed.
const msg::BodyStatus* entryOf(const msg::Status& status, const std::string& body);
/// A body's state as ~status has it.
int stateOf(const msg::Status& status, const std::string& body);
std::uint64_t counter(const msg::Status& status, const std::string& name);
/// Index of a pair in ~pairs, the smaller name first; -1 if it is not there.
int indexOf(const msg::Pairs& pairs, const std::string& first, const std::string& second);
/// Every pair as "first|second", in the order of the message.
std::vector<std::string> namesOf(const msg::Pairs& pairs);
/// Every event as "7 BEGIN MOVED first|second", in the order of the message.
std::vector<std::string> eventsOf(const msg::Events& events);

}  // namespace test
}  // namespace hgrid
