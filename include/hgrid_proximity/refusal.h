// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace hgrid {

/// Why something was refused. The numbers are part of the interface: do not change them.
enum class Code : std::uint16_t {
  ok = 0,
  bad_id = 1,
  dup_id = 2,
  unknown_id = 3,
  nonfinite = 4,
  out_of_range = 5,
  bad_geometry = 6,
  bad_rotation = 7,
  limit = 8,
  unknown_frame = 9,
  tf_timeout = 10,
  extrapolation = 11,
  clock = 12,
  parse = 13,
  truncated = 14,
  unsupported = 15,
  resource_denied = 16,
  resource_missing = 17,
  budget = 18,
  busy = 19,
  not_ready = 20,
  version = 21,
  checksum = 22,
  internal = 23,
  conflict = 24,
  needs_force = 25,
  failed = 26,
};

/// The code as a word, as in "OUT_OF_RANGE".
const char* name(Code code);

/// Bad input, refused at the door: a stable code and one sentence that names the thing, the value
/// and the rule. Whoever throws it has changed nothing.
class Refusal : public std::runtime_error {
 public:
  Refusal(Code code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  Code code() const { return code_; }

 private:
  Code code_;
};

/// A number as people write it ("0.05", "1e-320", "nan"), independent of the locale.
std::string text(double value);

/// A duration [s] to the millisecond, as in "0.25 s".
std::string secondsText(double duration);

/// Text from outside made safe for logs and messages: control characters and broken UTF-8 become
/// \xNN, and what is longer than `longest` bytes is cut with a "…".
std::string printable(const std::string& raw, std::size_t longest = 128);

}  // namespace hgrid
