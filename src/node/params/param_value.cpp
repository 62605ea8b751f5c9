// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/param_value.h"

#include <cmath>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

const char* typeName(XmlRpc::XmlRpcValue::Type type) {
  switch (type) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return "a boolean";
    case XmlRpc::XmlRpcValue::TypeInt:
      return "an integer";
    case XmlRpc::XmlRpcValue::TypeDouble:
      return "a number";
    case XmlRpc::XmlRpcValue::TypeString:
      return "a string";
    case XmlRpc::XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpc::XmlRpcValue::TypeStruct:
      return "a dictionary";
    default:
      return "of another type";
  }
}

}  // namespace

void ParamValue::wrongType(const std::string& expected) {
  std::string shown;
  if (value_.getType() == XmlRpc::XmlRpcValue::TypeString) {
    shown = " ('" + printable(static_cast<std::string&>(value_), 48) + "')";
  }
  error(std::string("is ") + typeName(value_.getType()) + shown + "; it must be " + expected);
}

void ParamValue::number(double& result, double low, double high, const std::string& unit) {
  double value = 0.0;
  if (value_.getType() == XmlRpc::XmlRpcValue::TypeInt) {
    value = static_cast<int&>(value_);
  } else if (value_.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
    value = static_cast<double&>(value_);
  } else {
    return wrongType("a number");
  }
  const std::string suffix = unit.empty() ? "" : " " + unit;
  const bool bounded = std::isfinite(high);  // without bounds, NaN is accepted here and the caller checks it
  if (value < low || value > high || (bounded && std::isnan(value))) {
    return error("is " + text(value) + suffix + "; it must be within " + text(low) + " .. " + text(high) + suffix);
  }
  result = value;
}

void ParamValue::integer(int& result, int low, int high) {
  if (value_.getType() != XmlRpc::XmlRpcValue::TypeInt) return wrongType("an integer");
  const int value = value_;
  if (value < low || value > high) {
    return error("is " + std::to_string(value) + "; it must be within " + std::to_string(low) + " .. " +
                 std::to_string(high));
  }
  result = value;
}

void ParamValue::flag(bool& result) {
  if (value_.getType() != XmlRpc::XmlRpcValue::TypeBoolean) return wrongType("true or false");
  result = value_;
}

void ParamValue::string(std::string& result) {
  if (value_.getType() != XmlRpc::XmlRpcValue::TypeString) return wrongType("a string");
  result = static_cast<std::string&>(value_);
}

void ParamValue::vector(Eigen::Vector3d& result, double limit) {
  std::vector<ParamValue> numbers = elements();
  if (numbers.size() != 3) {
    if (value_.getType() == XmlRpc::XmlRpcValue::TypeArray) {
      error("has " + std::to_string(numbers.size()) + " elements; it must have 3");
    }
    return;
  }
  for (int axis = 0; axis < 3; ++axis) numbers[static_cast<std::size_t>(axis)].number(result[axis], -limit, limit, "");
}

void ParamValue::strings(std::vector<std::string>& result) {
  result.clear();
  for (ParamValue& element : elements()) {
    result.emplace_back();
    element.string(result.back());
  }
}

std::vector<ParamValue> ParamValue::elements() {
  std::vector<ParamValue> list;
  if (value_.getType() != XmlRpc::XmlRpcValue::TypeArray) {
    wrongType("a list");
    return list;
  }
  for (int i = 0; i < value_.size(); ++i) list.emplace_back(value_[i], path_ + "[" + std::to_string(i) + "]", *errors_);
  return list;
}

bool ParamValue::requireStruct() {
  if (!isStruct()) wrongType("a dictionary");
  return isStruct();
}

std::optional<ParamValue> ParamValue::get(const std::string& key) {
  taken_.insert(key);
  if (!isStruct() || !value_.hasMember(key)) return std::nullopt;
  return ParamValue(value_[key], path_ == "~" ? path_ + key : path_ + "/" + key, *errors_);
}

std::optional<ParamValue> ParamValue::require(const std::string& key) {
  std::optional<ParamValue> value = get(key);
  if (!value && isStruct()) error("has no '" + key + "'; it must have one");
  return value;
}

void ParamValue::finish(const char* noun) {
  if (!isStruct()) return;
  for (auto& member : value_) {
    if (taken_.count(member.first) == 0) {
      errors_->push_back((path_ == "~" ? path_ : path_ + "/") + printable(member.first) + " is not a " + noun +
                         "; the name may be misspelled");
    }
  }
}

}  // namespace hgrid
