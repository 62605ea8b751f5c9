// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "report.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "question_stream.h"

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
         ", \"world\": " + quoted(m.title) + ", \"distances\": " + (m.distances ? "true" : "false") +
         (m.maps_per_s ? ", \"maps_per_s\": " + number(*m.maps_per_s) : "");
}

void printLateCycles(const Measurement& m) {
  if (m.late_cycles > 0) std::printf("  %zu cycles of /tf were late: the machine is too busy\n", m.late_cycles);
}

void print(const char* what, const ServiceTimes& trips) {
  const std::vector<double>& p99 = trips.p99_of_turns;
  std::printf("  %-46s %10.3f %10.3f   of single spans: %.3f .. %.3f .. %.3f\n", what, trips.all.median, trips.all.p99,
              p99.front(), p99[p99.size() / 2], p99.back());
}

void print(const char* what, const Difference& difference) {
  std::printf("  %-46s %10s %10.3f   95 %% interval: %.3f .. %.3f\n", what, "", difference.p99, difference.low,
              difference.high);
}

}  // namespace

void print(const Measurement& m) {
  std::printf("\n%s, /tf and ticks at %g Hz: %zu ticks, %.0f near pairs\n", m.title.c_str(), m.rate, m.ticks, m.pairs);
  std::printf("  %-12s %10s %10s\n", "part", "median ms", "p99 ms");
  for (const Measurement::Part& part : m.parts) {
    std::printf("  %-12s %10.3f %10.3f\n", part.name.c_str(), part.milliseconds.median, part.milliseconds.p99);
  }
  std::printf("  the node uses %.1f %% of one processor\n", m.cpu_percent);
  printLateCycles(m);
  std::fflush(stdout);
}

void print(const MapMeasurement& m) {
  const Measurement &resting = m.resting, &replaced = m.replaced;
  std::printf("\n%s, /tf and ticks at %g Hz, %.0f queries per second: twice %zu ticks, %zu queries\n",
              resting.title.c_str(), resting.rate, QuestionStream::kRate, replaced.ticks, m.questions);
  std::printf("  map at rest / map replaced every second, 1 %% of its leaves changed, by a message of %.2f MB\n",
              1e-6 * static_cast<double>(m.message_bytes));
  std::printf("  %-14s %21s %12s %21s %12s\n", "part", "median ms", "difference", "p99 ms", "difference");
  for (std::size_t i = 0; i < resting.parts.size(); ++i) {
    const Spread &without = resting.parts[i].milliseconds, &with = replaced.parts[i].milliseconds;
    std::printf("  %-14s %9.3f / %9.3f %+12.3f %9.3f / %9.3f %+12.3f\n", resting.parts[i].name.c_str(), without.median,
                with.median, with.median - without.median, without.p99, with.p99, with.p99 - without.p99);
  }
  std::printf(
      "  the node uses %.1f / %.1f %% of one processor, this program, which sends maps and queries, %.1f / %.1f %%,\n"
      "  all other programs %.1f / %.1f %%\n",
      resting.cpu_percent, replaced.cpu_percent, resting.bench_percent, replaced.bench_percent, resting.others_percent,
      replaced.others_percent);
  printLateCycles(resting);
  printLateCycles(replaced);
  std::fflush(stdout);
}

void print(const ControlMeasurement& m) {
  std::printf("\n%s at 100 Hz (%zu transforms per cycle), beside controls that only use ROS\n", m.title.c_str(),
              m.transforms);
  std::printf("  %-46s %10s %10s\n", "", "median ms", "p99 ms");
  std::printf("  %-46s %10.3f %10.3f\n", "stamp to arrival, relayed by a control", m.relay.median, m.relay.p99);
  print("round trip of an empty service", m.empty_service);
  print("the same in a control that also receives /tf", m.empty_service_beside_tf);
  print("round trip of ~query_sphere", m.sphere);
  print("its p99 minus that of the empty service", m.above_empty);
  print("its p99 minus that of the control with /tf", m.above_empty_beside_tf);
  std::printf(
      "  receiving /tf, percent of one processor: the node %.2f, a control with an empty callback %.2f, ratio %.2f\n",
      m.receiving.node, m.receiving.control, m.receiving.node / m.receiving.control);
  std::printf("  with one cycle of /tf per second: the node %.2f, the control %.2f\n", m.idle.node, m.idle.control);
  std::printf("  ratio of the differences: %.2f (median of %zu starts: %.2f .. %.2f)\n", m.timesOf(m.receiving),
              m.times.size(), m.times.front(), m.times.back());
  std::fflush(stdout);
}

void print(const ChangeMeasurement& m) {
  std::printf("\n%zu bodies, 100 of them move, and obstacles are added\n", m.bodies);
  std::printf("  ticks without a change: median %.2f ms, longest %.2f ms\n", m.resting_ms, m.longest_resting_ms);
  for (const ChangeMeasurement::Row& row : m.rows) {
    std::printf("  %6zu added per request, requests %2zu: longest tick %7.2f ms, median time of the answer %7.2f ms\n",
                row.added, row.requests, row.longest_tick_ms, row.answer_ms);
  }
  std::fflush(stdout);
}

void print(const BatchMeasurement& m) {
  std::printf("\n%s: %zu questions, %zu hits\n", m.title.c_str(), m.questions, m.hits);
  std::printf("  service %8.3f ms   library %8.3f ms   ratio %5.2f   %.2f million questions per second\n", m.service_ms,
              m.library_ms, m.ratio, 1e-3 * static_cast<double>(m.questions) / m.service_ms);
  std::fflush(stdout);
}

void print(const GuardMeasurement& m) {
  std::printf("\n~conflicts, 4 Pandas with paths of 10 s, an obstacle moves %zu times\n", m.moves);
  std::printf("  from the tick to ~conflicts: paths free %8.3f ms   in conflict %8.3f ms\n", m.free_ms, m.conflict_ms);
  std::fflush(stdout);
}

void writeJson(const std::string& file, const std::string& commit, const std::vector<Measurement>& measurements,
               const std::optional<ControlMeasurement>& controls, const std::optional<ChangeMeasurement>& changes,
               const std::vector<BatchMeasurement>& batches, const std::optional<GuardMeasurement>& guard) {
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
    if (m.maps_per_s) {
      out << ",\n  " << beginOf(m) << ", \"part\": \"cpu of the bench\", \"percent\": " << number(m.bench_percent)
          << "}";
      out << ",\n  " << beginOf(m) << ", \"part\": \"cpu of others\", \"percent\": " << number(m.others_percent) << "}";
    }
    out << ",\n  " << beginOf(m) << ", \"part\": \"near pairs\", \"count\": " << number(m.pairs) << "}";
  }
  if (controls) {
    const auto spread = [&](const char* part, const Spread& milliseconds) {
      out << ",\n  {\"kind\": \"node control\", \"world\": " << quoted(controls->title)
          << ", \"part\": " << quoted(part) << ", \"median_ms\": " << number(milliseconds.median)
          << ", \"p99_ms\": " << number(milliseconds.p99) << "}";
    };
    spread("relay", controls->relay);
    spread("empty service", controls->empty_service.all);
    spread("empty service beside /tf", controls->empty_service_beside_tf.all);
    spread("query_sphere", controls->sphere.all);
    const auto difference = [&](const char* part, const Difference& above) {
      out << ",\n  {\"kind\": \"node control\", \"world\": " << quoted(controls->title)
          << ", \"part\": " << quoted(part) << ", \"p99_ms\": " << number(above.p99)
          << ", \"low_ms\": " << number(above.low) << ", \"high_ms\": " << number(above.high) << "}";
    };
    difference("query_sphere above empty service", controls->above_empty);
    difference("query_sphere above empty service beside /tf", controls->above_empty_beside_tf);
    out << ",\n  {\"kind\": \"node control\", \"world\": " << quoted(controls->title)
        << ", \"part\": \"receiving\", \"percent\": " << number(controls->receiving.node)
        << ", \"empty_callback_percent\": " << number(controls->receiving.control)
        << ", \"idle_percent\": " << number(controls->idle.node)
        << ", \"idle_empty_callback_percent\": " << number(controls->idle.control) << "}";
  }
  for (const ChangeMeasurement::Row& row : changes ? changes->rows : std::vector<ChangeMeasurement::Row>()) {
    out << ",\n  {\"kind\": \"node change\", \"bodies\": " << changes->bodies
        << ", \"resting_ms\": " << number(changes->resting_ms)
        << ", \"longest_resting_ms\": " << number(changes->longest_resting_ms) << ", \"added\": " << row.added
        << ", \"requests\": " << row.requests << ", \"longest_tick_ms\": " << number(row.longest_tick_ms)
        << ", \"answer_ms\": " << number(row.answer_ms) << "}";
  }
  for (const BatchMeasurement& m : batches) {
    out << ",\n  {\"kind\": \"node batch\", \"title\": " << quoted(m.title) << ", \"questions\": " << m.questions
        << ", \"hits\": " << m.hits << ", \"service_ms\": " << number(m.service_ms)
        << ", \"library_ms\": " << number(m.library_ms) << ", \"ratio\": " << number(m.ratio) << "}";
  }
  if (guard) {
    out << ",\n  {\"kind\": \"node guard\", \"moves\": " << guard->moves << ", \"free_ms\": " << number(guard->free_ms)
        << ", \"conflict_ms\": " << number(guard->conflict_ms) << "}";
  }
  out << "\n]\n";
  if (!out.flush()) throw std::runtime_error(file + " cannot be written");
}

}  // namespace bench
}  // namespace hgrid
