// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/options.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "bench/workload/workloads.h"

namespace hgrid {
namespace bench {
namespace {

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream in(list);
  for (std::string item; std::getline(in, item, ',');) items.push_back(item);
  return items;
}

/// Returns `items` unchanged. @throws std::invalid_argument if an item is not one of `names`.
std::vector<std::string> known(const std::vector<std::string>& items, const std::vector<std::string>& names) {
  for (const std::string& item : items) {
    if (std::find(names.begin(), names.end(), item) != names.end()) continue;
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    throw std::invalid_argument(item + " is unknown; the known names are " + all);
  }
  return items;
}

std::vector<std::string> allWorkloads() {
  std::vector<std::string> names = evenWorkloads();
  names.insert(names.end(), unevenWorkloads().begin(), unevenWorkloads().end());
  names.insert(names.end(), {"building", "geb079", "cloud"});  // the part "maps" has these workloads
  return names;
}

double numberOf(const std::string& text) {
  std::size_t used = 0;
  const double value = std::stod(text, &used);
  if (used != text.size()) throw std::invalid_argument(text + " is not a number");
  return value;
}

bool wanted(const std::vector<std::string>& list, const std::string& item) {
  return list.empty() || std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

const char* const kUsage =
    "usage: hgrid_bench [--quick] [--json FILE] [--commit TEXT] [--command TEXT]\n"
    "                   [--part pairs,real,loading,ageing,threads,queries,single,maps,meshes,history,states,book,\n"
    "                    exactness]\n"
    "                   [--n 1000,...]\n"
    "                   [--workload uniform,mixed,floor,robots,heaps2,heaps64,fleet,strays,diagonal,levy,rods,giants,\n"
    "                    torus,tower,line,decades,onecell,sizes,building,geb079,cloud]\n"
    "                   [--moving 1,0.1,0.01] [--movers same,changing] [--peer 'hgrid,sweep,FCL DynamicAABBTree,...'] "
    "[--questions 100000]\n"
    "                   [--limit SECONDS] [--worlds FOLDER]\n";

bool Options::part(const std::string& name) const { return wanted(parts, name); }
bool Options::workload(const std::string& name) const { return wanted(workloads, name); }
std::vector<std::string> Options::boxWorkloads(const std::vector<std::string>& usual) const {
  if (workloads.empty()) return usual;
  std::vector<std::string> named;
  for (const auto* known : {&evenWorkloads(), &unevenWorkloads()}) {
    for (const std::string& name : *known) {
      if (workload(name)) named.push_back(name);
    }
  }
  return named;
}

bool Options::peer(const std::string& name) const { return wanted(peers, name); }

Options parsed(int count, const char* const* arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string name = arguments[i];
    if (name == "--quick") {
      options.quick = true;
      continue;
    }
    if (i + 1 == count) throw std::invalid_argument("unknown option, or its value is missing: " + name);
    const std::string value = arguments[++i];
    if (name == "--json") {
      options.json = value;
    } else if (name == "--commit") {
      options.commit = value;
    } else if (name == "--command") {
      options.command = value;
    } else if (name == "--worlds") {
      options.worlds = value;
    } else if (name == "--part") {
      options.parts = split(value);
    } else if (name == "--workload") {
      options.workloads = known(split(value), allWorkloads());
    } else if (name == "--peer") {
      options.peers = split(value);
    } else if (name == "--movers") {
      options.movers = known(split(value), {"same", "changing"});
    } else if (name == "--n") {
      for (const std::string& item : split(value)) options.sizes.push_back(static_cast<std::size_t>(numberOf(item)));
    } else if (name == "--moving") {
      for (const std::string& item : split(value)) options.moving.push_back(numberOf(item));
    } else if (name == "--limit") {
      options.limit = numberOf(value);
      if (!(options.limit > 0.0 && options.limit <= 1e6)) {
        throw std::invalid_argument("--limit must be above 0 and at most 1000000 s; it is " + value);
      }
    } else if (name == "--questions") {
      const double questions = numberOf(value);
      options.questions = questions >= 1e3 && questions <= 1e7 ? static_cast<std::size_t>(questions) : 0;
      if (options.questions == 0 || options.questions % 1000 != 0) {
        throw std::invalid_argument("--questions must be a multiple of 1000 from 1000 to 10000000; it is " + value);
      }
    } else {
      throw std::invalid_argument("unknown option: " + name);
    }
  }
  return options;
}

}  // namespace bench
}  // namespace hgrid
