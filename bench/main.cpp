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
  if (options.part("pairs")) runPairs(options, records);
  if (options.part("loading") && !(options.quick && options.parts.empty())) runLoadings(options, records);
  if (options.part("ageing")) runAgeing(options, records);
  if (options.part("threads") && options.peer("hgrid")) runThreads(options, records);
  if (options.part("queries")) runQueries(options, records);
  if (options.part("book") && !options.parts.empty()) runBook(options, records);  // only if it is named
  if (options.part("maps") && !(options.quick && options.parts.empty())) runMaps(options, records);
  if (options.part("meshes")) runMeshes(options, records);
  if (options.part("history")) runHistory(options, records);
#ifdef HGRID_BENCH_STATES
  if (options.part("states")) runStates(options, records);
#endif
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
