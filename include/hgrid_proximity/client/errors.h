// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Code.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace hgrid_proximity {

/// Base class of the errors of a client. After a query, each of them means: treat the place as occupied.
class ProximityError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The node does not run, does not answer in time, or the connection broke. The next call connects again.
class NoAnswer : public ProximityError {
 public:
  using ProximityError::ProximityError;
};

/// The node refused the request, or it failed.
class Refused : public ProximityError {
 public:
  /// Creates an error. @param reason  the code of the response @param index  see failed_index
  explicit Refused(const Code& reason, std::uint32_t index = 0)
      : ProximityError(reason.name + ": " + reason.text), code(reason), failed_index(index) {}
  Code code;                   ///< the reason, as a number, as a word and as a sentence for people
  std::uint32_t failed_index;  ///< Client::apply(): index of the refused change; 0 if there is none
};

}  // namespace hgrid_proximity
