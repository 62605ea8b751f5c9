// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares how fast broad phases are. The program writes its results to a JSON file, from which bench/report makes
// tables and verdicts.
#include <signal.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "bench/parts.h"
#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

#ifndef HGRID_BENCH_STATES
void runStates(const Options&, std::vector<Record>&) {
  std::printf(
      "\n-- without states: FCL, urdfdom, console_bridge or tinyxml2 was not found when this program was built\n");
}
#endif

namespace {

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

Record runRecord(const Options& options) {
  std::string missing;
  for (const std::string& name : missingPeers()) missing += (missing.empty() ? "" : ", ") + name;
  Record record("run");
  record.text("cpu", processor()).text("compiler", "g++ " __VERSION__).text("commit", options.commit);
  return record.text("command", options.command).flag("quick", options.quick).text("missing", missing);
}

int run(const Options& options) {
  for (const std::string& name : missingPeers())
    std::printf("-- without %s: its library was not found when this program was built\n", name.c_str());
  std::vector<Record> records{runRecord(options)};
  const bool named = !options.parts.empty();
  // Runs a part that is named, or if none is named and this part usually runs. A named part must measure something.
  const auto part = [&](const std::string& name, bool usual, void (*measure)(const Options&, std::vector<Record>&)) {
    if (!options.part(name) || (!named && !usual)) return;
    const std::size_t before = records.size();
    measure(options, records);
    if (named && records.size() == before)
      throw std::runtime_error("--part " + name +
                               " measured nothing: what it needs is missing, or no option selects it");
  };
  part("pairs", true, runPairs);
  part("real", true, runReal);
  part("loading", !options.quick, runLoadings);
  part("ageing", true, runAgeing);
  part("threads", true, runThreads);
  part("queries", true, runQueries);
  part("single", true, runSingle);
  part("book", false, runBook);
  part("exactness", false, runExactness);
  part("maps", !options.quick, runMaps);
  part("meshes", true, runMeshes);
  part("history", true, runHistory);
  part("states", true, runStates);
  if (!options.json.empty()) writeRecords(options.json, records);
  return 0;
}

}  // namespace
}  // namespace bench
}  // namespace hgrid

int main(int count, char** arguments) {
  signal(SIGPIPE, SIG_IGN);  // Contestant::play() itself detects that a child process has ended
  try {
    return hgrid::bench::run(hgrid::bench::parsed(count, arguments));
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n%s", error.what(), hgrid::bench::kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
