// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/fuzz/param_text.h"

#include <cstdlib>
#include <ctime>
#include <string>

namespace hgrid {
namespace test {
namespace {

using XmlRpc::XmlRpcValue;

constexpr int kDeepest = 100;

class Parser {
 public:
  explicit Parser(std::string_view text) : left_(text) {}

  XmlRpcValue value(int depth) {
    skip(" ,:\n");
    if (depth > kDeepest) left_ = {};  // ignores the rest of the text
    if (left_.empty()) return {};
    const char first = left_[0];
    if (std::string_view("+-.0123456789ni").find(first) != std::string_view::npos) return number();
    left_.remove_prefix(1);
    switch (first) {
      case '{':
        return dictionary(depth);
      case '[':
        return list(depth);
      case '\'':
        return XmlRpcValue(upTo("'"));
      case 't':
      case 'f':
        upTo(" ,]}");
        return XmlRpcValue(first == 't');
      case 'D': {
        std::tm date{};
        return XmlRpcValue(&date);
      }
      case 'B':
        return XmlRpcValue(&kBinary[0], sizeof(kBinary));
      default:
        return {};
    }
  }

 private:
  static inline char kBinary[3] = {0, 1, 2};

  void skip(const char* characters) {
    left_.remove_prefix(std::min(left_.find_first_not_of(characters), left_.size()));
  }
  /// Returns the text before the first character that is in `ends`. Removes this text, and a closing quote after it.
  std::string upTo(const char* ends) {
    const std::size_t size = std::min(left_.find_first_of(ends), left_.size());
    std::string text(left_.substr(0, size));
    left_.remove_prefix(size);
    if (!left_.empty() && left_[0] == '\'') left_.remove_prefix(1);
    return text;
  }
  bool ends(char end) {
    skip(" ,\n");
    if (left_.empty()) return true;
    if (left_[0] != end) return false;
    left_.remove_prefix(1);
    return true;
  }
  XmlRpcValue dictionary(int depth) {
    XmlRpcValue result;
    result.begin();  // makes the value a dictionary
    while (!ends('}')) {
      const std::string key = upTo(":}");
      result[key] = value(depth + 1);
    }
    return result;
  }
  XmlRpcValue list(int depth) {
    XmlRpcValue result;
    result.setSize(0);
    for (int i = 0; !ends(']'); ++i) result[i] = value(depth + 1);
    return result;
  }
  XmlRpcValue number() {
    const std::string text = upTo(" ,]}\n'");
    if (text.find_first_of(".enif") != std::string::npos) return XmlRpcValue(std::strtod(text.c_str(), nullptr));
    return XmlRpcValue(static_cast<int>(std::strtol(text.c_str(), nullptr, 10)));
  }

  std::string_view left_;
};

}  // namespace

XmlRpcValue paramsFrom(std::string_view text) { return Parser(text).value(0); }

}  // namespace test
}  // namespace hgrid
