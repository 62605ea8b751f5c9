// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/maps/map.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "bench/maps/building.h"
#include "bench/maps/map_peer.h"
#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_oracle.h"

namespace hgrid {
namespace bench {

Map building(std::size_t leaves, const std::string& folder) {
  Map map{"building", folder + "/building.bt", 0.05, buildingOf(leaves)};
  const std::string nodes = test::binaryNodesOf(map.leaves);
  const std::size_t count = nodes.size() / 2 + leaves;  // `nodes` contains two bytes for each inner node
  std::ofstream out(map.file, std::ios::binary);
  out << test::btHeader("id OcTree\nsize " + std::to_string(count) + "\nres 0.05\n") << nodes;
  if (!out.flush()) throw std::runtime_error("cannot write " + map.file);
  return map;
}

Map mapOfFile(const std::string& name, const std::string& file) {
  Octomap read = readMap(file);
  return {name, file, read.resolution, std::move(read.occupied)};
}

std::string fileOfGeb079() {
  const char* told = std::getenv("HGRID_TEST_DATA");
  const std::filesystem::path folder = told ? told : HGRID_PROJECT_DIR "/../shared/data";
  const std::filesystem::path file = folder / "octomap" / "geb079.bt";
  return std::filesystem::exists(file) ? file.string() : std::string();
}

}  // namespace bench
}  // namespace hgrid
