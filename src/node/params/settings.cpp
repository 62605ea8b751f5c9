// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/settings.h"

#include <string>

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

/// Returns the 64-bit hash of a text by the hash function FNV-1a.
std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

}  // namespace

Settings readSettings(const ros::NodeHandle& private_node) {
  const XmlRpc::XmlRpcValue values = valuesOf(private_node);
  return {readParams(values), fnv1a(values.toXml())};
}

}  // namespace hgrid
