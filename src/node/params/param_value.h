// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// One value of the parameter tree. It knows its path, so that every error message can name it. Errors are collected
/// instead of thrown, so that the user sees all of them at once.
class ParamValue {
 public:
  ParamValue(XmlRpc::XmlRpcValue value, std::string path, std::vector<std::string>& errors)
      : value_(std::move(value)), path_(std::move(path)), errors_(&errors) {}

  const std::string& path() const { return path_; }
  void error(const std::string& rule) const { errors_->push_back(path_ + " " + rule); }

  // Each of these functions reads the value into `result`. If the value has the wrong type or is out of range, they
  // add an error and leave `result` unchanged.
  void number(double& result, double low, double high, const std::string& unit);
  void integer(int& result, int low, int high);
  void flag(bool& result);
  void string(std::string& result);
  void vector(Eigen::Vector3d& result, double limit);
  void strings(std::vector<std::string>& result);

  /// Returns the elements of a list. If the value is not a list, adds an error and returns nothing.
  std::vector<ParamValue> elements();
  // Members of a struct. finish() adds an error for each member for which neither get() nor require() was called.
  bool isList() const { return value_.getType() == XmlRpc::XmlRpcValue::TypeArray; }
  bool isStruct() const { return value_.getType() == XmlRpc::XmlRpcValue::TypeStruct; }
  /// As isStruct(), but adds an error if the value is not a struct.
  bool requireStruct();
  /// Returns the member with this key; nullopt if there is none.
  std::optional<ParamValue> get(const std::string& key);
  /// As get(), but adds an error if there is no such member.
  std::optional<ParamValue> require(const std::string& key);
  /// @param noun  what a member would be, as in "field of a pose", for the error message
  void finish(const char* noun);

 private:
  void wrongType(const std::string& expected);

  XmlRpc::XmlRpcValue value_;
  std::string path_;
  std::vector<std::string>* errors_;
  std::set<std::string> taken_;
};

}  // namespace hgrid
