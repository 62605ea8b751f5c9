// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "report.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace hgrid {
namespace bench {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string beginOf(const Measurement& m) {
  return "{\"kind\": \"node\", \"bodies\": " + std::to_string(m.bodies) + ", \"rate_hz\": " + number(m.rate) +
         ", \"world\": " + quoted(m.title) + ", \"distances\": " + (m.distances ? "true" : "false");
}

}  // namespace

void print(const Measurement& m) {
  std::printf("\n%s, /tf and ticks at %g Hz: %zu ticks, %.0f near pairs\n", m.title.c_str(), m.rate, m.ticks, m.pairs);
  std::printf("  %-12s %10s %10s\n", "part", "median ms", "p99 ms");
  for (const Measurement::Part& part : m.parts) {
    std::printf("  %-12s %10.3f %10.3f\n", part.name.c_str(), part.milliseconds.median, part.milliseconds.p99);
  }
  std::printf("  the node takes %.1f %% of one processor\n", m.cpu_percent);
  if (m.late_cycles > 0) std::printf("  %zu cycles of /tf were late: the machine is too busy\n", m.late_cycles);
  std::fflush(stdout);
}

void writeJson(const std::string& file, const std::string& commit, const std::vector<Measurement>& measurements) {
  std::ofstream out(file);
  out << "[\n  {\"kind\": \"run\", \"cpu\": " << quoted(processor()) << ", \"compiler\": " << quoted("gcc " __VERSION__)
      << ", \"commit\": " << quoted(commit) << "}";
  for (const Measurement& m : measurements) {
    for (const Measurement::Part& part : m.parts) {
      out << ",\n  " << beginOf(m) << ", \"part\": " << quoted(part.name)
          << ", \"median_ms\": " << number(part.milliseconds.median)
          << ", \"p99_ms\": " << number(part.milliseconds.p99) << "}";
    }
    out << ",\n  " << beginOf(m) << ", \"part\": \"cpu\", \"percent\": " << number(m.cpu_percent) << "}";
    out << ",\n  " << beginOf(m) << ", \"part\": \"near pairs\", \"count\": " << number(m.pairs) << "}";
  }
  out << "\n]\n";
  if (!out.flush()) throw std::runtime_error(file + " cannot be written");
}

}  // namespace bench
}  // namespace hgrid
