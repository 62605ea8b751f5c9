// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tools/mesh/stl_file.h"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "hgrid_proximity/refusal.h"
#include "tools/mesh/text_numbers.h"

namespace hgrid {
namespace {

constexpr char kBlanks[] = " \t\r\n\v\f";

/// Whether the bytes are a binary STL file: after a header of 80 bytes, the number of triangles determines its size.
bool isBinary(const std::string& data) {
  if (data.size() < 84) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, data.data() + 80, sizeof(triangles));
  return data.size() == 84 + std::uint64_t{50} * triangles;
}

void addVertex(const Eigen::Vector3f& place, Faces& faces) {
  faces.places.push_back(place);
  const auto count = static_cast<std::uint32_t>(faces.places.size());
  if (count % 3 == 0) faces.add(count - 3, count - 2, count - 1);
}

Faces readBinary(const std::string& data) {
  Faces faces;
  for (std::size_t at = 84; at < data.size(); at += 50) {  // normal, three vertices, two bytes
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Eigen::Vector3f place;
      std::memcpy(place.data(), data.data() + at + 12 * (corner + 1), 12);
      addVertex(place, faces);
    }
  }
  return faces;
}

/// Reads a text file word by word. The names after `solid` and `endsolid` do not count.
class TextReader {
 public:
  explicit TextReader(const std::string& data) : data_(data) {}

  Faces read() {
    for (std::string word = next(); !word.empty(); word = next()) {
      if (word == "facet") {
        whole_ = whole_ && faces_.places.size() == 3 * facets_;
        ++facets_;
      } else if (word == "vertex") {
        readVertex();
      } else if (word == "solid" || word == "endsolid") {
        ended_ = word == "endsolid";
        at_ = std::min(data_.find_first_of("\r\n", at_), data_.size());
      }
    }
    if (!ended_) {
      throw Refusal(Code::truncated,
                    "it does not end with 'endsolid', so it may have been written only in part; write it again");
    }
    if (!whole_ || faces_.places.size() != 3 * facets_) {
      throw Refusal(Code::parse, "it has " + std::to_string(facets_) + " facets and " +
                                     std::to_string(faces_.places.size()) +
                                     " vertices; each facet must have 3 vertices");
    }
    if (!error_.empty()) throw Refusal(Code::parse, error_);
    return std::move(faces_);
  }

 private:
  /// Returns the next word in small letters, empty at the end.
  std::string next() {
    const std::size_t end = nextWord(data_, at_, kBlanks);
    std::string word = data_.substr(at_, end - at_);
    for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    at_ = end;
    return word;
  }

  /// Keeps the first error. It is reported only if the file is complete.
  void readVertex() {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t before = at_;
      try {
        place[axis] = readNumber(next());
      } catch (const Refusal& refusal) {
        if (error_.empty()) error_ = std::string("it has a vertex whose coordinate ") + refusal.what();
        at_ = before;
        break;
      }
    }
    addVertex(place.cast<float>(), faces_);
  }

  const std::string& data_;
  std::size_t at_ = 0;  // index in data_ after the last word
  Faces faces_;
  std::size_t facets_ = 0;
  bool whole_ = true;   // whether each facet before the last one has 3 vertices
  bool ended_ = false;  // whether an `endsolid` follows the last `solid`
  std::string error_;
};

}  // namespace

Faces readStl(const std::string& data) {
  if (isBinary(data)) return readBinary(data);
  std::size_t first = 0;
  nextWord(data, first, kBlanks);
  if (data.compare(first, 5, "solid") != 0) {
    throw Refusal(Code::parse,
                  "it is not an STL file: its size is not that of a binary one, and it does not begin with 'solid'");
  }
  if (data.find('\0') != std::string::npos) {
    throw Refusal(Code::parse, "it has a zero byte at byte " + std::to_string(data.find('\0')) +
                                   "; a text STL file must not contain one");
  }
  return TextReader(data).read();
}

}  // namespace hgrid
