// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <stdlib.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "bench/maps/cloud_stream.h"
#include "bench/maps/map_play.h"
#include "bench/measure/match.h"
#include "bench/parts.h"

namespace hgrid {
namespace bench {
namespace {

/// A temporary folder. The destructor removes the folder and its files.
class ScratchFolder {
 public:
  ScratchFolder() : path_((std::filesystem::temp_directory_path() / "hgrid_bench.XXXXXX").string()) {
    if (!mkdtemp(&path_[0])) throw std::runtime_error("cannot create the folder " + path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Adds a peer to the match. OctoMap's answers are the reference, or FCL's answers if OctoMap does not take part.
void add(Match& match, const MapPeerKind& kind, const std::function<Contestant::Play()>& begin) {
  const bool is_peer = kind.name.rfind("hgrid", 0) != 0;
  match.add(std::make_unique<Contestant>(begin, 1), is_peer, is_peer);
}

Record recordOf(const Map& map, const MapPeerKind& kind, const std::string& query, const Score& score,
                const std::string& status) {
  Record record("map");
  record.text("peer", kind.name).text("query", query).text("map", map.name);
  record.number("leaves", double(map.leaves.size())).number("spread", score.spread);
  return record.bits("checksum", score.checksum)
      .flag("correct", score.correct && status == "ok")
      .text("status", status);
}

/// One map and the peers that are compared on it.
struct Setting {
  const Options& options;
  const Map& map;
  std::vector<const MapPeerKind*> kinds;

  int rounds() const { return options.quick ? 3 : 5; }
  double budget() const { return options.quick ? 20.0 : 100.0; }  // [ms] time for each block of samples
};

std::vector<const MapPeerKind*> kindsFor(const Options& options, const Map& map) {
  std::vector<const MapPeerKind*> kinds;
  for (const MapPeerKind& kind : mapPeers()) {
    if (!options.peer(kind.name)) continue;
    if (map.leaves.size() <= kind.most) {
      kinds.push_back(&kind);
    } else {
      std::printf("  without %s: it takes far too long with more than %zu leaves\n", kind.name.c_str(), kind.most);
    }
  }
  return kinds;
}

/// Measures how long it takes to load each peer from the file and to build it from the leaves. Also measures how many
/// bytes the peer holds.
void playMaking(const Setting& setting, std::vector<Record>& records) {
  const Map& map = setting.map;
  struct Run {
    const MapPeerKind* kind;
    const char* query;
    MapPeerKind::Make make;
  };
  std::vector<Run> runs;
  for (const MapPeerKind* kind : setting.kinds) {
    if (kind->from_file) runs.push_back({kind, "load", kind->from_file});
    if (kind->from_leaves) runs.push_back({kind, "build", kind->from_leaves});
  }
  Match match;
  for (const Run& run : runs) {
    add(match, *run.kind, [&map, run]() -> Contestant::Play { return MakeMapPlay(map, run.make); });
  }
  match.play(setting.rounds(), setting.budget(), 60.0);

  const std::vector<Score> scores = match.scores();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Score& score = scores[i];
    const std::string& status = match.contestant(i).status();
    const double bytes = score.bytes / double(map.leaves.size());
    records.push_back(recordOf(map, *runs[i].kind, runs[i].query, score, status));
    records.back().number("median_ms", score.median_ms).number("min_ms", score.min_ms).number("bytes_per_leaf", bytes);
    std::printf("  %-28s %-12s %10.3f ms  spread %3.0f %%  %8.2f B  %s\n", runs[i].kind->name.c_str(), runs[i].query,
                score.median_ms, 100.0 * score.spread, bytes, remarkOn(score, status));
  }
  std::fflush(stdout);
}

/// Measures how long the peers take to answer questions of one kind, in random order and all at once (batched).
void playAsking(const Setting& setting, const std::vector<std::unique_ptr<MapPeer>>& peers,
                const MapQuestions& questions, const MapDoubts& doubts, MapQuestion question,
                std::vector<Record>& records) {
  const Map& map = setting.map;
  struct Run {
    const MapPeerKind* kind;
    MapPeer* peer;
    bool batched;
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < peers.size(); ++i) {
    if (!peers[i]->answers(question)) continue;
    for (const bool batched : {false, true}) runs.push_back({setting.kinds[i], peers[i].get(), batched});
  }
  Match match;
  for (const Run& run : runs) {
    add(match, *run.kind, [&, run]() -> Contestant::Play {
      const auto play = std::make_shared<AskMapPlay>(*run.peer, question, run.batched, map, questions, doubts);
      return [play](double budget_ms) { return (*play)(budget_ms); };
    });
  }
  match.play(setting.rounds(), setting.budget(), 60.0);

  const std::vector<Score> scores = match.scores();
  const double compared = double(questions.size() - doubts.count());
  std::printf("  %s: %zu questions, %zu of them not compared: rounding may decide them\n", name(question),
              questions.size(), doubts.count());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Score& score = scores[i];
    const std::string& status = match.contestant(i).status();
    const double per_sample = double(runs[i].batched ? questions.size() : AskMapPlay::kChunk);
    const double us = 1e3 * score.median_ms / per_sample;
    Record record = recordOf(map, *runs[i].kind, name(question), score, status);
    record.flag("batched", runs[i].batched).number("median_us", us).number("min_us", 1e3 * score.min_ms / per_sample);
    record.number("hits_per_query", double(score.count) / compared);
    record.number("compared", compared).number("in_doubt", double(doubts.count()));
    records.push_back(record);
    std::printf("  %-28s %-12s %10.4f us  spread %3.0f %%  %8.2f hits  %s\n", runs[i].kind->name.c_str(),
                runs[i].batched ? "batched" : "single", us, 100.0 * score.spread, double(score.count) / compared,
                remarkOn(score, status));
  }
  std::fflush(stdout);
}

void play(const Options& options, const Map& map, std::vector<Record>& records) {
  std::printf("\nmap %s, %zu occupied leaves of %g m or more\n", map.name.c_str(), map.leaves.size(), map.resolution);
  const Setting setting{options, map, kindsFor(options, map)};
  playMaking(setting, records);
  std::vector<std::unique_ptr<MapPeer>> peers;  // built once; the child processes inherit them
  for (const MapPeerKind* kind : setting.kinds) {
    peers.push_back((kind->from_file ? kind->from_file : kind->from_leaves)(map));
  }
  const MapQuestions questions(map, (options.quick ? 2 : 10) * AskMapPlay::kChunk);
  const StaticGrid grid(map.resolution, map.leaves);
  for (const MapQuestion question : kMapQuestions) {
    playAsking(setting, peers, questions, MapDoubts(grid, questions, question), question, records);
  }
}

}  // namespace

void runMaps(const Options& options, std::vector<Record>& records) {
  std::vector<std::size_t> sizes{1000000, 10000000};
  if (options.quick) sizes.pop_back();
  if (!options.sizes.empty()) sizes = options.sizes;
  if (options.workload("geb079")) {
    const std::string file = fileOfGeb079();
    if (file.empty()) {
      std::printf("\nwithout the map geb079: no octomap/geb079.bt in HGRID_TEST_DATA or ../shared/data\n");
    } else {
      play(options, mapOfFile("geb079", file), records);
    }
  }
  if (options.workload("cloud")) playClouds(records);
  if (!options.workload("building")) return;
  const ScratchFolder folder;
  for (const std::size_t leaves : sizes) play(options, building(leaves, folder.path()), records);
}

}  // namespace bench
}  // namespace hgrid
