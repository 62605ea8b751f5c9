// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>

#include <initializer_list>
#include <string>
#include <utility>

namespace hgrid {
namespace test {

// Functions that build parameter values, as a YAML file would contain them.

using Value = XmlRpc::XmlRpcValue;

/// Sets a member. The key "group/key" names the member `key` of the dictionary `group`.
inline void set(Value& params, const std::string& key, const Value& value) {
  const std::size_t slash = key.find('/');
  if (slash == std::string::npos) {
    params[key] = value;
  } else {
    params[key.substr(0, slash)][key.substr(slash + 1)] = value;
  }
}

inline Value dict(std::initializer_list<std::pair<const char*, Value>> members = {}) {
  Value value;
  value.begin();  // makes the value a dictionary, even if no member follows
  for (const auto& member : members) set(value, member.first, member.second);
  return value;
}

inline Value list(std::initializer_list<Value> elements = {}) {
  Value value;
  value.setSize(static_cast<int>(elements.size()));
  int i = 0;
  for (const Value& element : elements) value[i++] = element;
  return value;
}

inline Value xyz(double x, double y, double z) { return list({Value(x), Value(y), Value(z)}); }

/// Returns an obstacle with one sphere. Center and radius are in m.
inline Value ball(const std::string& name, double x, double y, double z, double radius, const std::string& frame = "") {
  return dict({{"name", name},
               {"frame", frame},
               {"pose", dict({{"xyz", xyz(x, y, z)}})},
               {"shapes", list({dict({{"type", "sphere"}, {"radius", radius}})})}});
}

/// Returns an obstacle with one box [m]. The sides of the box are parallel to the axes of its frame.
inline Value box(const std::string& name, const Value& at, const Value& size, const std::string& frame = "") {
  return dict({{"name", name},
               {"frame", frame},
               {"pose", dict({{"xyz", at}})},
               {"shapes", list({dict({{"type", "box"}, {"size", size}})})}});
}

/// Returns an entry of ~accept_uncovered.
inline Value waiver(const std::string& pattern, const std::string& reason) {
  return dict({{"pattern", pattern}, {"reason", reason}});
}

/// Returns a copy of `params` in which these members are changed or added.
inline Value with(Value params, std::initializer_list<std::pair<const char*, Value>> members) {
  for (const auto& member : members) set(params, member.first, member.second);
  return params;
}

}  // namespace test
}  // namespace hgrid
