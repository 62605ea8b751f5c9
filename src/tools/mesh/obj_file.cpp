// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tools/mesh/obj_file.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"
#include "tools/mesh/text_numbers.h"

namespace hgrid {
namespace {

// Characters that separate the words of a line.
constexpr char kBlanks[] = " \t\v\f";

// Statements that add no surface.
const char* const kSkipped[] = {"vt",     "vn",         "vp",        "g",      "o",     "s",        "mg",
                                "usemtl", "mtllib",     "usemap",    "maplib", "bevel", "c_interp", "d_interp",
                                "lod",    "shadow_obj", "trace_obj", "l",      "p"};

std::vector<std::string> wordsOf(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t at = 0, end = 0; (end = nextWord(line, at, kBlanks)) > at; at = end) {
    words.push_back(line.substr(at, end - at));
  }
  return words;
}

/// Whether a word is a corner of a face: v, v/vt, v//vn or v/vt/vn, with or without slashes at its end. Each number may
/// have a minus sign.
bool isCorner(const std::string& word) {
  std::size_t at = 0;
  const auto readNumber = [&] {
    if (at < word.size() && word[at] == '-') ++at;
    const std::size_t begin = at;
    at = std::min(word.find_first_not_of("0123456789", begin), word.size());
    return at > begin;
  };
  if (!readNumber()) return false;
  for (int part = 0; part < 2 && at < word.size(); ++part) {
    if (word[at++] != '/') return false;
    if (at < word.size() && word[at] != '/' && !readNumber()) return false;
  }
  return at == word.size();
}

/// Returns the number of a corner's vertex, from 0 on.
/// @param before  number of vertices before the face; negative numbers count back from there
std::uint32_t vertexOf(const std::string& corner, std::size_t before) {
  const bool back = corner[0] == '-';
  const std::uint32_t number = readIndex(corner.substr(back ? 1 : 0, corner.find('/') - (back ? 1 : 0)));
  if (number == 0 || (back && number > before)) {
    throw Refusal(Code::bad_geometry, "a face has the corner '" + corner + "', but the file has " +
                                          std::to_string(before) + " vertices before it; they are counted from 1");
  }
  return back ? static_cast<std::uint32_t>(before - number) : number - 1;
}

void readFace(const std::string& line, const std::vector<std::string>& words, Faces& faces) {
  const std::string face = "its face '" + printable(line, 60) + "'";
  if (words.size() < 4) throw Refusal(Code::parse, face + " has fewer than 3 corners");
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!isCorner(words[i])) {
      throw Refusal(Code::parse, face + " has the corner '" + printable(words[i], 40) +
                                     "'; a corner must be v, v/vt, v//vn or v/vt/vn with whole numbers");
    }
    faces.corners.push_back(vertexOf(words[i], faces.places.size()));
  }
  faces.ends.push_back(faces.corners.size());
}

/// Reads a vertex: x y z, x y z 1, x y z r g b or x y z r g b a. A weight other than 1 belongs to a curve, and programs
/// do not agree on what else it means.
void readVertex(const std::string& line, const std::vector<std::string>& words, Faces& faces) {
  std::vector<double> numbers;
  for (std::size_t i = 1; i < words.size(); ++i) numbers.push_back(readNumber(words[i]));
  const std::size_t count = numbers.size();
  if (!(count == 3 || (count == 4 && numbers[3] == 1.0) || count == 6 || count == 7)) {
    throw Refusal(Code::parse, "its vertex '" + printable(line, 60) +
                                   "' must have 3 coordinates; a weight that follows must be 1, or a color may follow");
  }
  faces.places.push_back(Eigen::Vector3d(numbers[0], numbers[1], numbers[2]).cast<float>());
}

void readLine(const std::string& line, Faces& faces) {
  const std::vector<std::string> words = wordsOf(line);
  if (words.empty() || words[0][0] == '#') return;
  if (words[0] == "v") return readVertex(line, words, faces);
  if (words[0] == "f") return readFace(line, words, faces);
  if (std::find(std::begin(kSkipped), std::end(kSkipped), words[0]) == std::end(kSkipped)) {
    throw Refusal(Code::unsupported, "it has the statement '" + printable(words[0], 40) +
                                         "', which is not read; export the whole surface as faces ('f')");
  }
}

/// Refuses a file that ends within a line, or that contains a zero byte.
void checkText(const std::string& data) {
  if (data.find('\0') != std::string::npos) {
    throw Refusal(Code::parse, "it has a zero byte at byte " + std::to_string(data.find('\0')) +
                                   "; an OBJ file must be text without zero bytes");
  }
  std::size_t at = data.find_last_of("\r\n") + 1;  // begin of the last line; 0 if there is no line break
  if (nextWord(data, at, kBlanks) > at && data[at] != '#') {
    throw Refusal(Code::truncated,
                  "its last line has no line break, so it may have been written only in part; write it again, or add "
                  "a line break if it is complete");
  }
}

}  // namespace

Faces readObj(const std::string& data) {
  checkText(data);
  Faces faces;
  std::string line;
  for (std::size_t at = data.compare(0, 3, "\xef\xbb\xbf") == 0 ? 3 : 0; at < data.size(); ++at) {  // the mark of UTF-8
    if (data[at] != '\n' && data[at] != '\r') {
      line += data[at];
      continue;
    }
    if (data.compare(at, 2, "\r\n") == 0) ++at;
    if (!line.empty() && line.back() == '\\') {  // the next line continues this one
      line.back() = ' ';
      continue;
    }
    readLine(line, faces);
    line.clear();
  }
  if (!line.empty() && line.back() == '\\') line.back() = ' ';
  readLine(line, faces);
  return faces;
}

}  // namespace hgrid
