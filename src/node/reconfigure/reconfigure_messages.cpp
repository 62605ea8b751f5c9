// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/reconfigure/reconfigure_messages.h"

#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr const char* kGroup = "Default";  // all parameters are in one group; clients expect that its id is 0

template <class Entry, class Value>
void add(const std::string& name, Value value, std::vector<Entry>& entries) {
  Entry entry;
  entry.name = name;
  entry.value = value;
  entries.push_back(entry);
}

void add(const std::string& name, const ChangeableValue& value, dynamic_reconfigure::Config& config) {
  if (const auto* flag = std::get_if<bool>(&value)) add(name, *flag, config.bools);
  if (const auto* integer = std::get_if<int>(&value)) add(name, *integer, config.ints);
  if (const auto* number = std::get_if<double>(&value)) add(name, *number, config.doubles);
}

void addGroup(dynamic_reconfigure::Config& config) {
  config.groups.emplace_back();
  config.groups.back().name = kGroup;
  config.groups.back().state = true;
}

const char* typeOf(const ChangeableValue& value) {
  constexpr const char* kTypes[] = {"bool", "int", "double"};
  return kTypes[value.index()];
}

template <class Value, class Entries>
void take(const Entries& entries, ParamChange& change) {
  for (const auto& entry : entries) {
    if (!change.emplace(entry.name, static_cast<Value>(entry.value)).second) {
      throw Refusal(Code::dup_id, "~" + printable(entry.name) + " is given twice; give each parameter one value");
    }
  }
}

}  // namespace

dynamic_reconfigure::ConfigDescription descriptionMessage() {
  dynamic_reconfigure::ConfigDescription message;
  message.groups.emplace_back();
  message.groups.back().name = kGroup;
  for (const ChangeableParam& param : changeableParams(Params{})) {
    dynamic_reconfigure::ParamDescription row;
    row.name = param.name;
    row.type = typeOf(param.value);
    row.description = param.meaning;
    message.groups.back().parameters.push_back(row);
    add(param.name, param.value, message.dflt);
    add(param.name, param.low, message.min);
    add(param.name, param.high, message.max);
  }
  for (dynamic_reconfigure::Config* config : {&message.dflt, &message.min, &message.max}) addGroup(*config);
  return message;
}

dynamic_reconfigure::Config configMessage(const Params& params) {
  dynamic_reconfigure::Config message;
  for (const ChangeableParam& param : changeableParams(params)) add(param.name, param.value, message);
  addGroup(message);
  return message;
}

ParamChange changeOf(const dynamic_reconfigure::Config& config) {
  if (!config.strs.empty()) {
    throw Refusal(Code::unsupported, "~" + printable(config.strs.front().name) +
                                         " is given as a string; no parameter that may change at run time is a string");
  }
  const std::size_t count = config.bools.size() + config.ints.size() + config.doubles.size();
  const std::size_t most = changeableParams(Params{}).size();
  if (count > most) {
    throw Refusal(Code::limit, "the request has " + std::to_string(count) + " values; only " + std::to_string(most) +
                                   " parameters may change at run time");
  }
  ParamChange change;
  take<bool>(config.bools, change);
  take<int>(config.ints, change);
  take<double>(config.doubles, change);
  return change;
}

}  // namespace hgrid
