// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace test {

/// A rule that all answers must satisfy. Counts the checks and the violations, and keeps the worst violation.
class Claim {
 public:
  Claim(std::string sentence, double limit) : sentence_(std::move(sentence)), limit_(limit) {}

  /// Records one check. An error above the limit, or an error of NaN, counts as a violation.
  void hold(double error, const Case& seen);
  void hold(bool truth, const Case& seen) { hold(truth ? 0.0 : 1.0, seen); }
  /// Fails the running test if there was a violation.
  void expectHeld() const;

  double worst() const { return worst_; }
  std::size_t count() const { return count_; }

 private:
  std::string sentence_;
  double limit_;
  double worst_ = 0.0;
  std::size_t count_ = 0, faults_ = 0;
  std::string worst_case_;
};

/// Checks that the fields of an answer agree with each other. @returns what is wrong; empty if nothing is wrong
std::string unsound(const Proximity& answer, double up_to = std::numeric_limits<double>::infinity());

/// Compares the answers of the narrow phase with those of the distance oracle.
class Judge {
 public:
  /// @param error  [m] largest allowed error of a distance and of a nearest point
  explicit Judge(double error = 1e-6);

  /// Measures the case in both orders and judges the answers.
  void look(const Case& placed);
  void expectAllHeld() const;
  /// Returns one line with the number of answers and their largest errors.
  std::string figures() const;

 private:
  void judgeApart(const Case& placed, const Proximity& answer, const Interval& truth);
  void judgeContact(const Case& placed, const Proximity& answer, const Interval& truth);

  Claim sound_, same_, distance_, false_contact_, missed_, on_shapes_, between_points_, normal_, depth_;
  double widest_ = 0.0;  // [m] width of the oracle's widest interval
};

}  // namespace test
}  // namespace hgrid
