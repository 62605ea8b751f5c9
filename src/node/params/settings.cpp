// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/settings.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/refusal.h"
#include "node/text/text_hash.h"

namespace hgrid {
namespace {

XmlRpc::XmlRpcValue valuesOf(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue values;
  if (!node.getParam(node.getNamespace(), values) || values.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    values = XmlRpc::XmlRpcValue();
    values.begin();  // turns the value into an empty struct: no parameter is set
  }
  return values;
}

/// Writes a value to its place in a struct of parameters. The name "group/key" means the member `key` of the struct
/// `group`.
void write(const std::string& name, const ChangeableValue& value, XmlRpc::XmlRpcValue& values) {
  const std::size_t slash = name.find('/');
  XmlRpc::XmlRpcValue& place =
      slash == std::string::npos ? values[name] : values[name.substr(0, slash)][name.substr(slash + 1)];
  std::visit([&place](auto known) { place = XmlRpc::XmlRpcValue(known); }, value);
}

}  // namespace

Settings readSettings(const ros::NodeHandle& private_node) {
  const XmlRpc::XmlRpcValue values = valuesOf(private_node);
  return {readParams(values), fnv1a(values.toXml()), values};
}

ParamChange differencesOf(const ParamChange& change, const Settings& settings) {
  const std::vector<ChangeableParam> known = changeableParams(settings.params);
  ParamChange differences;
  for (const auto& [name, value] : change) {
    const auto same = [&wanted = name](const ChangeableParam& param) { return param.name == wanted; };
    const auto param = std::find_if(known.begin(), known.end(), same);
    if (param == known.end()) {
      throw Refusal(Code::unsupported, "~" + printable(name) +
                                           " cannot change while the node runs; doc/parameters.md says which "
                                           "parameters can. Set it before the start of the node");
    }
    const auto* const integer = std::get_if<int>(&value);
    const bool is_number = std::holds_alternative<double>(param->value);
    const ChangeableValue wanted = integer && is_number ? ChangeableValue(static_cast<double>(*integer)) : value;
    if (wanted != param->value) differences.emplace(name, wanted);
  }
  return differences;
}

Settings changedSettings(const Settings& settings, const ParamChange& change) {
  Settings result;
  result.values = settings.values;
  for (const auto& [name, value] : change) write(name, value, result.values);
  std::vector<std::string> errors;
  result.params = readParams(result.values, errors);
  if (!errors.empty()) {
    std::string sentence = errors.front();
    const std::size_t others = errors.size() - 1;
    if (others == 1) sentence += "; 1 other rule is broken, too";
    if (others > 1) sentence += "; " + std::to_string(others) + " other rules are broken, too";
    throw Refusal(Code::out_of_range, sentence);
  }
  result.config_hash = fnv1a(result.values.toXml());
  return result;
}

}  // namespace hgrid
