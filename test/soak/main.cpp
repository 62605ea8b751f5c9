// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// node_soaktest puts a constant load on a node for a long time. It prints a table with one line for each tenth of this
// time. test/soak/run starts it and judges the table.
//
// The load is 1,000 moving bodies at 100 Hz on /tf, one map of 200,000 leaves per second, and 200 queries per second.

#include <ros/init.h>
#include <ros/spinner.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bench/node/map_stream.h"
#include "bench/node/measurement.h"
#include "bench/node/question_stream.h"
#include "bench/node/running_node.h"
#include "bench/node/workload.h"
#include "status_watch.h"

namespace hgrid {
namespace soak {
namespace {

using Clock = std::chrono::steady_clock;

constexpr char kTopic[] = "/soak_map";
constexpr std::size_t kBodies = 1000;
constexpr std::size_t kLeaves = 200000;
constexpr double kRate = 100.0;  // [Hz] rate of messages on /tf, and of ticks
constexpr int kRows = 10;

/// Returns the memory of a process that is in RAM [byte].
double residentBytes(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("VmRSS:", 0) == 0) return 1024.0 * std::stod(line.substr(6));
  }
  throw std::runtime_error("the node has ended");
}

/// Returns how many things the node has refused or lost, plus how often two publishers placed a frame differently.
std::uint64_t troubles(const Heard& heard) {
  std::uint64_t sum = 0;
  for (const auto& counter : heard.counters) {
    for (const char* word : {"refused", "failed", "dropped", "fight"}) {
      if (counter.first.find(word) != std::string::npos) sum += counter.second;
    }
  }
  return sum;
}

/// Returns a counter of the audit as text; "-" if the node does not have this counter.
std::string audited(const std::map<std::string, std::uint64_t>& counters, const char* name) {
  const auto found = counters.find(name);
  return found == counters.end() ? "-" : std::to_string(found->second);
}

/// A node and the programs that put the load on it.
class Soak {
 public:
  explicit Soak(double duration)
      : workload_(bench::inBuilding(bench::freeBodies(kBodies, kRate), kTopic)),
        maps_(kTopic, kLeaves),
        node_(workload_, duration),
        watch_(node_.name()),
        questions_(node_.name()) {
    while (watch_.take().messages == 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    first_ = watch_.take();
    last_ = first_;
  }

  /// Loads the node for `duration` [s] and prints a row of the table.
  void row(int number, double duration);
  /// Prints all counters of the node, and why the world was incomplete.
  void printRest() const;

 private:
  void load(double duration);
  void print(int number, double duration, const Heard& heard, std::uint64_t ticks);

  bench::Workload workload_;
  bench::MapStream maps_;
  bench::RunningNode node_;
  StatusWatch watch_;
  bench::QuestionStream questions_;
  bench::Sightings sightings_;
  bench::RoundTrips trips_;
  std::vector<double> resident_;  // [byte] one value per second
  Heard first_, last_;
  std::string reason_;
};

/// Sends one map per second. Measures the memory of the node once per second.
void Soak::load(double duration) {
  const auto begin = Clock::now();
  for (double due = 0.5; due < duration; due += 1.0) {
    std::this_thread::sleep_until(begin +
                                  std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due)));
    maps_.publishNext();
    resident_.push_back(residentBytes(node_.process().pid()));
  }
  std::this_thread::sleep_until(begin +
                                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(duration)));
}

void Soak::row(int number, double duration) {
  const std::uint64_t first = watch_.take().sequence;
  sightings_ = {};
  trips_ = {};
  resident_.clear();
  node_.watch(sightings_);
  questions_.noteIn(&trips_);
  load(duration);
  questions_.noteIn(nullptr);
  node_.rest();
  if (!node_.process().alive()) throw std::runtime_error("the node has ended");
  last_ = watch_.take();
  if (!last_.reason.empty()) reason_ = last_.reason;
  print(number, sightings_.duration, last_, last_.sequence - first);
}

void Soak::print(int number, double duration, const Heard& heard, std::uint64_t ticks) {
  const bench::Spread tick = bench::spreadOf(heard.ticks);
  std::vector<double> trips = trips_.sphere;
  trips.insert(trips.end(), trips_.segment.begin(), trips_.segment.end());
  const bench::Spread query = bench::spreadOf(trips);
  std::sort(resident_.begin(), resident_.end());
  const double missed = std::max(0.0, duration * kRate - static_cast<double>(ticks));
  std::printf(
      "%5d %8.1f %7llu %7.0f %10zu %9.3f %9.3f %10.3f %10.3f %8zu %7zu %8.2f %8.2f %5zu %5zu %8llu %8s %9s %5.0f "
      "%6.0f\n",
      number, duration, static_cast<unsigned long long>(ticks), missed, heard.incomplete, tick.median, tick.p99,
      query.median, query.p99, trips.size(), questions_.failures(), 1e-6 * resident_[resident_.size() / 2],
      1e-6 * resident_.back(), maps_.published(), questions_.replacements() + 1,
      static_cast<unsigned long long>(troubles(heard) - troubles(first_)),
      audited(heard.counters, "audit.checked").c_str(), audited(heard.counters, "audit.different").c_str(),
      100.0 * sightings_.node_time / duration, 100.0 * sightings_.others_time / duration);
  std::fflush(stdout);
}

void printHead(double duration) {
  std::printf("# %g s, %zu bodies at %g Hz on /tf, 1 map of %zu leaves per second, %g queries per second\n", duration,
              kBodies, kRate, kLeaves, bench::QuestionStream::kRate);
  std::printf("# times in ms, memory in MB, cpu in percent of one processor; from 'failed' on, counts are totals\n");
  std::printf("%5s %8s %7s %7s %10s %9s %9s %10s %10s %8s %7s %8s %8s %5s %5s %8s %8s %9s %5s %6s\n", "tenth",
              "seconds", "ticks", "missed", "incomplete", "tick_p50", "tick_p99", "query_p50", "query_p99", "queries",
              "failed", "rss", "rss_max", "maps", "used", "refusals", "audited", "different", "cpu", "others");
}

void Soak::printRest() const {
  if (!reason_.empty()) std::printf("# incomplete: %s\n", reason_.c_str());
  for (const auto& counter : last_.counters) {
    std::printf("# counter %s %llu\n", counter.first.c_str(), static_cast<unsigned long long>(counter.second));
  }
}

}  // namespace
}  // namespace soak
}  // namespace hgrid

int main(int argc, char** argv) {
  using namespace hgrid::soak;
  ros::init(argc, argv, "node_soaktest");
  const double duration = argc > 1 ? std::atof(argv[1]) : 1800.0;  // [s]
  try {
    ros::AsyncSpinner spinner(1);
    spinner.start();
    Soak soak(duration / kRows);
    printHead(duration);
    for (int number = 1; number <= kRows; ++number) soak.row(number, duration / kRows);
    soak.printRest();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "node_soaktest: %s\n", error.what());
    return 1;
  }
  return 0;
}
