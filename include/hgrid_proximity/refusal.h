// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace hgrid {

/// Why input was rejected. msg/CodeNames.msg describes each code. The numbers are part of the interface: do not change
/// them.
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

/// Returns the code as a word, such as "OUT_OF_RANGE".
const char* name(Code code);

/// Thrown when input is rejected. It holds a stable code and one sentence that names the object, its value and the rule
/// that it breaks. A function that throws a Refusal has changed nothing.
class Refusal : public std::runtime_error {
 public:
  /// Creates a refusal. @param sentence  returned by what()
  Refusal(Code code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  /// Returns why the input was rejected.
  Code code() const { return code_; }

 private:
  Code code_;
};

/// Returns a number as readable text, such as "0.05", "1e-320" or "nan". The locale does not matter.
std::string text(double value);

/// Returns a duration [s] as text, rounded to milliseconds, such as "0.25 s".
std::string secondsText(double duration);

/// Returns a length [m] as text, rounded to micrometers, such as "0.25 m". The coordinates of boxes are not more
/// precise.
std::string metersText(double length);

/// Returns text from outside in a form that is safe for logs and messages. Control characters and invalid UTF-8 become
/// `\xNN`. Text longer than `longest` bytes is cut and ends with "…".
std::string printable(const std::string& raw, std::size_t longest = 128);

}  // namespace hgrid
