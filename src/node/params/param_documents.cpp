// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <sstream>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/params/param_table.h"
#include "node/params/params.h"

namespace hgrid {
namespace {

/// One parameter, as the documents show it.
struct ParamRow {
  std::string section, name;
  std::string type;    ///< type of the value in YAML
  std::string unit;    ///< unit of the value; empty: it has none
  std::string value;   ///< default value, in YAML
  std::string range;   ///< allowed values; empty: `meaning` names them
  bool range_is_text;  ///< true: config/params.yaml appends the range to the meaning
  bool changeable;     ///< whether it may change while the node runs
  std::string meaning;
};

constexpr const char* kLimitsNote =
    "You need not touch these. They protect the process: nothing that arrives can fill its memory or take all of its "
    "time. The node says by name which limit it has reached.";
constexpr const char* kChangeable = "; may change at run time";

/// A visitor that collects all parameters in their order.
class RowCollector {
 public:
  void section(const char* title) { section_ = title; }
  void changeable() { changeable_ = true; }
  void string(const char* name, const std::string& value, const char* meaning) {
    add(name, "string", "", "\"" + value + "\"", "", meaning);
  }
  void vector(const char* name, const Eigen::Vector3d& value, const char* unit, double limit, const char* meaning) {
    const std::string shown = "[" + decimal(value[0]) + ", " + decimal(value[1]) + ", " + decimal(value[2]) + "]";
    add(name, "list of 3 doubles", unit, shown, "each within " + range(-limit, limit), meaning);
  }
  void number(const char* name, double value, const char* unit, double low, double high, const char* meaning) {
    add(name, "double", unit, decimal(value), range(low, high), meaning);
  }
  void integer(const char* name, int value, int low, int high, const char* meaning) {
    add(name, "int", "", std::to_string(value), std::to_string(low) + " .. " + std::to_string(high), meaning);
  }
  void flag(const char* name, bool value, const char* meaning) {
    addChoice(name, "bool", value ? "true" : "false", "true, false", meaning);
  }
  void kinds(const char* name, const PairKinds&, const char* meaning) {
    addChoice(name, "list of strings", "[" + words(kKinds) + "]", words(kKinds), meaning);
  }
  void unknownSpace(const char* name, UnknownSpace value, const char* meaning) {
    addChoice(name, "string", kUnknownSpace[static_cast<std::size_t>(value)], words(kUnknownSpace), meaning);
  }
  void broadPhase(const char* name, BroadPhaseType value, const char* meaning) {
    std::string all;
    for (const BroadPhaseType type : broadPhaseTypes())
      all += (all.empty() ? "" : ", ") + std::string(hgrid::name(type));
    addChoice(name, "string", hgrid::name(value), all, meaning);
  }
  void strings(const char* name, const std::vector<std::string>&, const char* meaning) {
    add(name, "list of strings", "", "[]", "", meaning);
  }
  void robots(const char* name, const std::vector<RobotParams>&, const char* meaning) { list(name, meaning); }
  void waivers(const char* name, const std::vector<Waiver>&, const char* meaning) { list(name, meaning); }
  void rooms(const char* name, const std::vector<Room>&, const char* meaning) { list(name, meaning); }
  void doors(const char* name, const std::vector<Portal>&, const char* meaning) { list(name, meaning); }
  void allowed(const char* name, const std::vector<PairRule>&, const char* meaning) { list(name, meaning); }
  void obstacles(const char* name, const std::vector<ObstacleParams>&, const char* meaning) { list(name, meaning); }
  void maps(const char* name, const std::vector<MapParams>&, const char* meaning) { list(name, meaning); }
  void clouds(const char* name, const std::vector<CloudParams>&, const char* meaning) { list(name, meaning); }
  void pathTopics(const char* name, const std::vector<PathTopicParams>&, const char* meaning) { list(name, meaning); }
  void trackers(const char* name, const std::vector<TrackerParams>&, const char* meaning) { list(name, meaning); }
  void pairMargins(const char* name, const std::vector<PairMargin>&, double low, double high, const char* meaning) {
    add(name, "list", "m", "[]", range(low, high), meaning);
  }
  void values(const char* name, const std::vector<PatternValue>&, const char*, const char* unit, double low,
              double high, const char* meaning) {
    add(name, "list", unit, "[]", range(low, high), meaning);
  }

  const std::vector<ParamRow>& rows() const { return rows_; }

 private:
  void list(const char* name, const char* meaning) { add(name, "list", "", "[]", "", meaning); }
  void add(const char* name, const char* type, const char* unit, const std::string& value, const std::string& range,
           const char* meaning) {
    rows_.push_back({section_, name, type, unit, value, range, true, std::exchange(changeable_, false), meaning});
  }
  void addChoice(const char* name, const char* type, const std::string& value, const std::string& choices,
                 const char* meaning) {
    rows_.push_back({section_, name, type, "", value, choices, false, std::exchange(changeable_, false), meaning});
  }

  static std::string range(double low, double high) { return text(low) + " .. " + text(high); }
  template <std::size_t count>
  static std::string words(const char* const (&list)[count]) {
    std::string all;
    for (const char* word : list) all += (all.empty() ? "" : ", ") + std::string(word);
    return all;
  }
  /// Returns a number with a decimal point: YAML 1.1 would read 1e+06 as a string, but it reads 1.0e+06 as a number.
  static std::string decimal(double value) {
    std::string shown = text(value);
    const std::size_t exponent = shown.find('e');
    if (shown.find('.') == std::string::npos)
      shown.insert(exponent == std::string::npos ? shown.size() : exponent, ".0");
    return shown;
  }

  std::string section_;
  bool changeable_ = false;
  std::vector<ParamRow> rows_;
};

std::vector<ParamRow> allRows() {
  Params defaults;
  RowCollector collector;
  visitParams(collector, defaults);
  return collector.rows();
}

/// Writes `sentence` as comment lines of at most 110 characters.
void writeComment(std::ostream& out, const std::string& indent, std::string sentence) {
  while (!sentence.empty()) {
    std::size_t end = sentence.size();
    if (end > 110) end = sentence.rfind(' ', 110);
    out << indent << "# " << sentence.substr(0, end) << "\n";
    sentence.erase(0, end + 1);
  }
}

/// Returns the text so that Markdown shows it unchanged in a cell of a table. Names of topics, services and parameters
/// become code: "~margin" is such a name.
std::string cell(const std::string& sentence) {
  std::string shown;
  bool name = false;
  for (const char c : sentence) {
    const bool letter = (c >= 'a' && c <= 'z') || c == '_' || c == '/';
    if (name && !letter) shown += '`';
    name = c == '~' || (name && letter);
    if (c == '~') shown += '`';
    if (!name && (c == '|' || c == '*' || c == '<')) shown += '\\';
    shown += c;
  }
  return shown + (name ? "`" : "");
}

}  // namespace

std::string paramsAsYaml() {
  std::ostringstream out;
  out << "# All parameters of proximity_node with their default values. A description begins with the unit in "
         "brackets\n"
         "# and ends with the allowed range, both ends included. Load the values that you change into the private\n"
         "# namespace of the node. The node does not start if a name is unknown.\n";
  std::string section, group;
  for (const ParamRow& row : allRows()) {
    if (row.section != section) {
      out << "\n# " << row.section << "\n";
      if (row.section == "Limits") writeComment(out, "", kLimitsNote);
      group.clear();
    }
    section = row.section;
    const std::size_t slash = row.name.find('/');
    const std::string row_group = slash == std::string::npos ? "" : row.name.substr(0, slash);
    if (row_group != group && !row_group.empty()) out << row_group << ":\n";
    group = row_group;
    const std::string indent = group.empty() ? "" : "  ";
    const bool with_range = row.range_is_text && !row.range.empty();
    writeComment(out, indent,
                 (row.unit.empty() ? "" : "[" + row.unit + "] ") + row.meaning + (with_range ? "; " + row.range : "") +
                     (row.changeable ? kChangeable : ""));
    out << indent << (group.empty() ? row.name : row.name.substr(slash + 1)) << ": " << row.value << "\n";
  }
  return out.str();
}

std::string paramsAsMarkdown() {
  std::ostringstream out;
  out << "# Parameters\n\n"
         "All parameters of `proximity_node`, in its private namespace. This page is generated from the table that the "
         "node reads\n"
         "them with. [config/params.yaml](../config/params.yaml) has the same contents as a file to copy from.\n"
         "[tuning.md](tuning.md) says which parameter serves which wish. [glossary.md](glossary.md) defines the "
         "terms.\n\n"
         "- Put the values that you change into a file, and start the node with it:\n"
         "  `roslaunch hgrid_proximity proximity.launch params:=/path/to/my_cell.yaml`.\n"
         "- `map/folder` is the key `folder` in the dictionary `map`. Ranges include both ends.\n"
         "- The node reads its parameters once, when it starts. It does not start if a name is unknown or a value is "
         "not allowed.\n"
         "  One message then lists every such parameter.\n"
         "- `dynamic_reconfigure` can change the parameters that \"may change at run time\" while the node runs; "
         "[tuning.md](tuning.md) says how.\n"
         "- A glob is a pattern for names in which `*` stands for any characters: `robot/*`.\n"
         "- `roslaunch` and `rosparam` read a file as YAML 1.1, before the node sees the values: `010` is 8, `yes` and "
         "`no` are true and false, and `1e3` is a text (write `1.0e3`). Scenes refuse numbers that begin with a "
         "needless zero.\n\n"
         "Some rules are about several parameters:\n\n"
         "- `~late_after` <= `~stale_after` <= `~lost_after`\n"
         "- `~valid_for` is at least one period of `~rate`, and of `~heartbeat` if `~follow_data` is true.\n"
         "- `~distances/max` <= `~margin`\n"
         "- `~map/crop_min` <= `~map/crop_max` on each axis\n"
         "- `~limits/min_size` < `~limits/max_size`\n"
         "- `~allowed_pairs` has at most `~limits/max_rules` entries.\n"
         "- `~robots` has at most `~limits/max_robots` entries.\n"
         "- `~maps` has at most `~limits/max_maps` entries.\n"
         "- `~world_frame` is required with several `~robots`.\n"
         "- Globs of `~padding` do not begin with `map/` or `cloud/`, because cells cannot be grown.\n";
  std::string section;
  for (const ParamRow& row : allRows()) {
    if (row.section != section) {
      out << "\n## " << row.section << "\n";
      if (row.section == "Limits") out << "\n" << kLimitsNote << "\n";
      out << "\n| name | type | unit | default | range | meaning |\n"
          << "| --- | --- | --- | --- | --- | --- |\n";
    }
    section = row.section;
    out << "| `" << row.name << "` | " << row.type << " | " << row.unit << " | `" << row.value << "` | " << row.range
        << " | " << cell(row.meaning) << (row.changeable ? kChangeable : "") << " |\n";
  }
  return out.str();
}

}  // namespace hgrid
