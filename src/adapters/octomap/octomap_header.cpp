// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/octomap/octomap_header.h"

#include <algorithm>
#include <charconv>
#include <locale>
#include <sstream>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestLine = 1024;
constexpr std::string_view kSpace = " \t\r";
constexpr std::string_view kBinaryMagic = "# Octomap OcTree binary file";
constexpr std::string_view kFullMagic = "# Octomap OcTree file";
constexpr std::string_view kLegacyMagic("\3\0\0\0", 4);  // OctoMap before 1.0 stored the tree type as an int

bool startsWith(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

/// Returns the text without white space at both ends. Also removes the \r of a line that ends with CRLF.
std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kSpace), text.size());
  return text.substr(begin, text.find_last_not_of(kSpace) + 1 - begin);
}

class HeaderReader {
 public:
  HeaderReader(std::string_view file, const std::string& what) : file_(file), what_(what) {}

  OctomapHeader read() {
    OctomapHeader header;
    header.format.binary = readMagic();
    for (std::string_view line = nextLine(); line != "data"; line = nextLine()) readLine(line);
    header.format.id = valueOf("id", id_);
    header.nodes = wholeNumber("size", valueOf("size", size_));
    header.format.resolution = number("res", valueOf("res", resolution_));
    header.data_offset = at_;
    return header;
  }

 private:
  [[noreturn]] void refuse(Code code, const std::string& sentence) const { throw Refusal(code, what_ + sentence); }

  /// Reads the first line. @returns true for a `.bt` file, false for an `.ot` file
  bool readMagic() {
    if (startsWith(file_, kLegacyMagic)) {
      refuse(Code::unsupported,
             " has the binary header of OctoMap before 1.0; convert it with OctoMap's convert_octree");
    }
    for (const std::string_view magic : {kBinaryMagic, kFullMagic}) {
      if (file_.size() < magic.size() && startsWith(magic, file_)) {
        refuse(Code::truncated,
               " ends after " + std::to_string(file_.size()) + " bytes, before the end of its first line");
      }
      if (startsWith(file_, magic)) {
        nextLine();
        return magic == kBinaryMagic;
      }
    }
    refuse(Code::parse, " begins with '" + shown(file_.substr(0, kBinaryMagic.size())) + "'; an OctoMap begins with '" +
                            std::string(kBinaryMagic) + "' or '" + std::string(kFullMagic) + "'");
  }

  std::string_view nextLine() {
    const std::string_view rest = file_.substr(at_, kLongestLine + 1);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos && rest.size() > kLongestLine) {
      refuse(Code::limit, " has a header line that is too long, '" + shown(rest) + "'; at most " +
                              std::to_string(kLongestLine) + " bytes are allowed");
    }
    if (end == std::string_view::npos) {
      refuse(Code::truncated,
             " ends after " + std::to_string(file_.size()) + " bytes, before the line 'data' that must end its header");
    }
    at_ += end + 1;
    return trimmed(rest.substr(0, end));
  }

  /// Reads the keywords id, size and res. Ignores comments and unknown keywords, because a newer OctoMap may add
  /// keywords.
  void readLine(std::string_view line) {
    const std::string_view key = line.substr(0, line.find_first_of(kSpace));
    const std::string_view value = trimmed(line.substr(key.size()));
    if (key == "id") setOnce(id_, key, value);
    if (key == "size") setOnce(size_, key, value);
    if (key == "res") setOnce(resolution_, key, value);
    if (key == "data") refuse(Code::parse, " has the header line '" + shown(line) + "'; the line must be only 'data'");
  }

  void setOnce(std::optional<std::string_view>& field, std::string_view key, std::string_view value) const {
    if (field) {
      refuse(Code::parse, " has two header lines '" + std::string(key) + "', '" + shown(*field) + "' and '" +
                              shown(value) + "'; only one is allowed");
    }
    field = value;
  }

  std::string valueOf(const char* key, const std::optional<std::string_view>& field) const {
    if (!field || field->empty()) {
      refuse(Code::parse,
             std::string(" has no value for '") + key + "' in its header; the header must have id, size and res");
    }
    return std::string(*field);
  }

  std::uint64_t wholeNumber(const char* key, const std::string& value) const {
    std::uint64_t number = 0;
    const auto parsed = std::from_chars(value.data(), value.data() + value.size(), number);
    if (parsed.ec != std::errc() || parsed.ptr != value.data() + value.size()) refuseNumber(key, value, "whole number");
    return number;
  }

  double number(const char* key, const std::string& value) const {
    double number = 0.0;
    std::istringstream in(value);
    in.imbue(std::locale::classic());  // always use '.' as the decimal point, in any locale
    if (!(in >> number) || in.peek() != std::istringstream::traits_type::eof()) refuseNumber(key, value, "number");
    return number;
  }

  [[noreturn]] void refuseNumber(const char* key, const std::string& value, const char* kind) const {
    refuse(Code::parse, std::string(" has ") + key + " '" + shown(value) + "' in its header; it must be a " + kind);
  }

  static std::string shown(std::string_view text) { return printable(std::string(text), 80); }

  std::string_view file_;
  const std::string& what_;
  std::size_t at_ = 0;
  std::optional<std::string_view> id_, size_, resolution_;
};

}  // namespace

OctomapHeader readOctomapHeader(std::string_view file, const std::string& what) {
  return HeaderReader(file, what).read();
}

}  // namespace hgrid
