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

/// One value of the parameter tree, read with its path, so that every error names it. Errors are collected,
/// not thrown: the user gets all of them at once.
class ParamValue {
 public:
  ParamValue(XmlRpc::XmlRpcValue value, std::string path, std::vector<std::string>& errors)
      : value_(std::move(value)), path_(std::move(path)), errors_(&errors) {}

  const std::string& path() const { return path_; }
  void error(const std::string& rule) const { errors_->push_back(path_ + " " + rule); }

  // Each leaves `result` as it is and notes an error where the value does not fit.
  void number(double& result, double low, double high, const std::string& unit);
  void integer(int& result, int low, int high);
  void flag(bool& result);
  void string(std::string& result);
  void vector(Eigen::Vector3d& result, double limit);
  void strings(std::vector<std::string>& result);

  /// Elements of a list; an error and none if it is not one.
  std::vector<ParamValue> elements();
  /// Members of a struct: get() takes one by its key, finish() notes an error for each that nobody took.
  bool isStruct() const { return value_.getType() == XmlRpc::XmlRpcValue::TypeStruct; }
  bool requireStruct();
  std::optional<ParamValue> get(const std::string& key);
  /// As get(), and an error if it is not there.
  std::optional<ParamValue> require(const std::string& key);
  void finish(const char* noun);

 private:
  void wrongType(const std::string& expected);

  XmlRpc::XmlRpcValue value_;
  std::string path_;
  std::vector<std::string>* errors_;
  std::set<std::string> taken_;
};

}  // namespace hgrid
