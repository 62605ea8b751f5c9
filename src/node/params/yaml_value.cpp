// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/yaml_value.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <limits>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kDeepest = 32;  // levels of lists and dictionaries

using XmlRpc::XmlRpcValue;

/// Returns the value of a scalar without quotes.
XmlRpcValue plainValue(const std::string& text) {
  if (text == "true" || text == "false") return XmlRpcValue(text == "true");
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789+-.eE") == std::string::npos;
  if (!is_number) return XmlRpcValue(text);
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  double value = 0.0;
  if (!(in >> value) || in.peek() != std::istringstream::traits_type::eof()) return XmlRpcValue(text);
  const bool is_integer = text.find_first_of(".eE") == std::string::npos;
  using Limits = std::numeric_limits<int>;
  if (is_integer && value >= Limits::min() && value <= Limits::max()) return XmlRpcValue(static_cast<int>(value));
  return XmlRpcValue(value);
}

/// Returns whether a text is a whole number in which a needless zero comes first. YAML 1.1 reads 010 as 8.
bool hasLeadingZero(const std::string& text) {
  const std::size_t first = text.find_first_not_of("+-");
  return first <= 1 && text.size() > first + 1 && text[first] == '0' &&
         text.find_first_not_of("0123456789", first) == std::string::npos;
}

/// Builds the value while yaml-cpp parses. The parser calls itself for each level, so the limit of the levels also
/// bounds its stack.
class Builder : public YAML::EventHandler {
 public:
  explicit Builder(std::string what) : what_(std::move(what)) {}

  XmlRpcValue take() { return std::move(result_); }
  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& why) const {
    throw Refusal(Code::parse, what_ + ", line " + std::to_string(mark.line + 1) + ": " + why);
  }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "there is an empty value; write a value, \"\" for an empty text, or leave the key out");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "there is an alias ('*'); write the value again instead");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
    if (!levels_.empty() && levels_.back().is_dictionary && !levels_.back().has_key) {
      levels_.back().key = value;
      levels_.back().has_key = true;
      if (levels_.back().value.hasMember(value)) refuse(mark, "'" + printable(value) + "' is there twice");
      return;
    }
    if (tag != "!" && hasLeadingZero(value)) {
      refuse(mark, "'" + value +
                       "' begins with a zero, which makes it an octal number for other readers of YAML; write it "
                       "without the zero, or in quotes if it is a text");
    }
    add(tag == "!" ? XmlRpcValue(value) : plainValue(value));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    begin(mark, false);
    levels_.back().value.setSize(0);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    begin(mark, true);
    levels_.back().value.begin();  // makes it a dictionary, even if no member follows
  }
  void OnMapEnd() override { end(); }

 private:
  struct Level {
    XmlRpcValue value;
    bool is_dictionary = false;
    bool has_key = false;  // in a dictionary: whether the key of the next value is known
    std::string key;
  };

  void begin(const YAML::Mark& mark, bool is_dictionary) {
    if (!levels_.empty() && levels_.back().is_dictionary && !levels_.back().has_key)
      refuse(mark, "a key is a list or a dictionary; it must be a text");
    if (levels_.size() == kDeepest) {
      refuse(mark, "there are more than " + std::to_string(kDeepest) + " levels of lists and dictionaries");
    }
    levels_.emplace_back();
    levels_.back().is_dictionary = is_dictionary;
  }
  void end() {
    XmlRpcValue value = std::move(levels_.back().value);
    levels_.pop_back();
    add(std::move(value));
  }
  void add(XmlRpcValue value) {
    if (levels_.empty()) {
      result_ = std::move(value);
    } else if (levels_.back().is_dictionary) {
      levels_.back().value[levels_.back().key] = value;
      levels_.back().has_key = false;
    } else {
      XmlRpcValue& list = levels_.back().value;
      list[list.size()] = value;
    }
  }

  const std::string what_;
  std::vector<Level> levels_;
  XmlRpcValue result_;
};

}  // namespace

XmlRpcValue valueOfYaml(const std::string& text, const std::string& what) {
  Builder builder(what);
  try {
    // yaml-cpp 0.6.3 (Debian 11) does not end, and allocates more and more memory, for some texts whose last line
    // breaks off. With an end of the line, it refuses them.
    std::istringstream in(text + "\n");
    YAML::Parser parser(in);
    if (!parser.HandleNextDocument(builder)) throw Refusal(Code::parse, what + " is empty");
    if (parser) throw Refusal(Code::parse, what + " has more than one document; remove what follows '---' or '...'");
  } catch (const YAML::Exception& flaw) {
    throw Refusal(Code::parse, what + ", line " + std::to_string(flaw.mark.line + 1) +
                                   " is not valid YAML: " + printable(flaw.msg, 200));
  }
  return builder.take();
}

}  // namespace hgrid
