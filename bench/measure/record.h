// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace hgrid {
namespace bench {

/// A JSON object without nested values. Functions add one field each.
class Record {
 public:
  explicit Record(const std::string& kind) { text("kind", kind); }

  Record& text(const std::string& name, const std::string& value);
  Record& number(const std::string& name, double value);
  Record& flag(const std::string& name, bool value) { return raw(name, value ? "true" : "false"); }
  /// Adds 64 bits as a string of 16 hexadecimal digits, because a JSON number cannot store them exactly.
  Record& bits(const std::string& name, unsigned long long value);

  std::string json() const { return "{" + fields_ + "}"; }

 private:
  Record& raw(const std::string& name, const std::string& value);

  std::string fields_;
};

/// Writes the records as one JSON array, one line per record. @throws std::runtime_error if the file cannot be written.
void writeRecords(const std::string& file, const std::vector<Record>& records);

}  // namespace bench
}  // namespace hgrid
