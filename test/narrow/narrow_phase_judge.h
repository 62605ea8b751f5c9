// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace test {

/// A sentence about all answers, with what was seen against it.
class Claim {
 public:
  Claim(std::string sentence, double limit) : sentence_(std::move(sentence)), limit_(limit) {}

  /// Beyond the limit, or NaN, the error counts as a fault.
  void hold(double error, const Case& seen);
  void hold(bool truth, const Case& seen) { hold(truth ? 0.0 : 1.0, seen); }
  /// Fails the running test if there was a fault.
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

/// What holds for every answer, whatever it says. @returns what is wrong with it, empty if nothing
std::string unsound(const Proximity& answer, double up_to = std::numeric_limits<double>::infinity());

/// Holds the answers of the narrow phase against the witness.
class Judge {
 public:
  /// @param error  [m] that a distance and a nearest point may have
  explicit Judge(double error = 1e-6);

  /// Measures the case in both orders and judges the answers.
  void look(const Case& placed);
  void expectAllHeld() const;
  /// One line: how many answers, the largest errors, how well the witness itself knew.
  std::string figures() const;

 private:
  void judgeApart(const Case& placed, const Proximity& answer, const Interval& truth);
  void judgeContact(const Case& placed, const Proximity& answer, const Interval& truth);

  Claim sound_, same_, distance_, false_contact_, missed_, on_shapes_, between_points_, normal_, depth_;
  double widest_ = 0.0;  // [m] of the witness's intervals
};

}  // namespace test
}  // namespace hgrid
