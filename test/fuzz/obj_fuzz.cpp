// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cstdlib>

#include "src/tools/mesh/obj_file.h"
#include "test/fuzz/obj_oracle.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

/// Returns what is wrong with what readObj() read from an OBJ file; empty if nothing is wrong.
std::string flawOfFaces(const Faces& faces, std::string_view file) {
  std::size_t vertices = 0, face = 0, corner = 0;
  for (const std::vector<std::string>& words : wordsOfObj(file)) {
    if (words.empty()) continue;
    if (words[0] == "v") {
      if (vertices == faces.places.size()) return "a vertex is missing";
      const Eigen::Vector3f& place = faces.places[vertices++];
      for (std::size_t i = 0; i < 3; ++i) {
        if (place[static_cast<int>(i)] != static_cast<float>(std::atof(words.at(i + 1).c_str()))) {
          return "a vertex is elsewhere";
        }
      }
    }
    if (words[0] != "f") continue;
    if (words.size() < 4) return "a face has fewer than 3 corners";
    if (face == faces.ends.size() || faces.ends[face++] != corner + words.size() - 1) return "a face is missing";
    for (std::size_t i = 1; i < words.size(); ++i, ++corner) {
      const long long number = std::atoll(words[i].c_str());
      const long long expected = number < 0 ? static_cast<long long>(vertices) + number : number - 1;
      if (expected != static_cast<long long>(faces.corners.at(corner))) return "a corner is another vertex";
    }
  }
  if (vertices != faces.places.size() || face != faces.ends.size()) return "there are too many vertices or faces";
  return {};
}

}  // namespace

FuzzResult fuzzObj(std::string_view input) {
  try {
    return {true, flawOfFaces(readObj(std::string(input)), input)};
  } catch (const Refusal& refusal) {
    return {false, flawOfSentence(printable(refusal.what(), 200))};  // the loader makes the sentence printable
  }
}

}  // namespace test
}  // namespace hgrid
