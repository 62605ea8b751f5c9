// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/measure/record.h"

#include <fstream>
#include <stdexcept>

namespace hgrid {
namespace bench {

Record& Record::raw(const std::string& name, const std::string& value) {
  if (!fields_.empty()) fields_ += ", ";
  fields_ += "\"" + name + "\": " + value;
  return *this;
}

Record& Record::text(const std::string& name, const std::string& value) {
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return raw(name, quoted + "\"");
}

Record& Record::number(const std::string& name, double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.9g", value);
  return raw(name, digits);
}

Record& Record::bits(const std::string& name, unsigned long long value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "\"%016llx\"", value);
  return raw(name, digits);
}

void writeRecords(const std::string& file, const std::vector<Record>& records) {
  std::ofstream out(file);
  const char* before = "[\n";
  for (const Record& record : records) {
    out << before << record.json();
    before = ",\n";
  }
  out << "\n]\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace bench
}  // namespace hgrid
