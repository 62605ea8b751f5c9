// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/refusal.h"

#include <cmath>
#include <cstdio>
#include <locale>
#include <sstream>

#include "utf8.h"

namespace hgrid {

const char* name(Code code) {
  static constexpr const char* kNames[] = {
      "OK",           "BAD_ID",       "DUP_ID",    "UNKNOWN_ID",    "NONFINITE",       "OUT_OF_RANGE",
      "BAD_GEOMETRY", "BAD_ROTATION", "LIMIT",     "UNKNOWN_FRAME", "TF_TIMEOUT",      "EXTRAPOLATION",
      "CLOCK",        "PARSE",        "TRUNCATED", "UNSUPPORTED",   "RESOURCE_DENIED", "RESOURCE_MISSING",
      "BUDGET",       "BUSY",         "NOT_READY", "VERSION",       "CHECKSUM",        "INTERNAL",
      "CONFLICT",     "NEEDS_FORCE",  "FAILED"};
  return kNames[static_cast<std::uint16_t>(code)];
}

std::string text(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  if (std::floor(value) == value && std::abs(value) < 1e9) {  // write 1000000, not 1e+06
    out << static_cast<long long>(value);
    return out.str();
  }
  if (std::isnan(value)) return "nan";
  for (int digits = 1; digits <= 17; ++digits) {  // find the shortest text that is read back as the same number
    out.str("");
    out.precision(digits);
    out << value;
    std::istringstream in(out.str());
    in.imbue(std::locale::classic());
    double back = 0.0;
    if (!std::isfinite(value) || (in >> back && back == value)) break;
  }
  return out.str();
}

std::string secondsText(double duration) { return text(std::round(duration * 1e3) / 1e3) + " s"; }

std::string metersText(double length) { return text(std::round(length * 1e6) / 1e6) + " m"; }

std::string printable(const std::string& raw, std::size_t longest) {
  std::string out;
  for (std::size_t i = 0; i < raw.size();) {
    if (out.size() >= longest) return out + "…";
    const std::size_t length = utf8Length(raw, i);
    if (length == 0) {
      char escaped[5];
      std::snprintf(escaped, sizeof(escaped), "\\x%02x", static_cast<unsigned char>(raw[i]));
      out += escaped;
      ++i;
    } else {
      out.append(raw, i, length);
      i += length;
    }
  }
  return out;
}

}  // namespace hgrid
