// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/bodies/kinematics.h"
#include "test/adapters/urdf_texts.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

/// Returns a chain of the links a, b, c and d. Moving joints connect them.
RobotModel chain() {
  return read(robot(link("a") + link("b") + link("c") + link("d") + joint("1", "a", "b", "continuous") +
                    joint("2", "b", "c", "continuous") + joint("3", "c", "d", "continuous")));
}

/// Returns the number of tags that name a pair of links or one link. Does not use the product's reader.
std::size_t tagsIn(const std::string& srdf) {
  tinyxml2::XMLDocument document;
  document.Parse(srdf.data(), srdf.size());
  std::size_t count = 0;
  for (const auto* tag = document.RootElement()->FirstChildElement(); tag; tag = tag->NextSiblingElement()) {
    const std::string name = tag->Name();
    const bool counts =
        name == "disable_collisions" || name == "enable_collisions" || name == "disable_default_collisions";
    count += counts ? 1 : 0;
  }
  return count;
}

/// Returns what is wrong with the rules and with the matrix that they make; empty if nothing is wrong.
std::string flawOfRules(const LinkRules& rules, const std::string& srdf) {
  static const RobotModel model = chain();
  if (rules.disabled.size() + rules.enabled.size() + rules.disabled_default.size() != tagsIn(srdf)) {
    return "not every tag is a rule";
  }
  std::vector<std::string> warnings;
  const LinkMatrix matrix(model, rules, warnings);
  for (const std::string& warning : warnings) {
    if (!flawOfSentence(warning).empty()) return flawOfSentence(warning);
  }
  for (std::uint32_t first = 0; first < matrix.size(); ++first) {
    if (matrix.origin(first, first) != Origin::self) return "a link and itself are a pair";
    for (std::uint32_t second = 0; second < first; ++second) {
      if (matrix.origin(first, second) != matrix.origin(second, first)) return "the matrix is not symmetric";
      const LinkMatrix::Tag* tag = matrix.tag(first, second);
      if (tag && tag->disabled != (matrix.origin(first, second) == Origin::srdf)) return "a tag does not count";
      if (tag && !tag->reason.empty() && !flawOfSentence(tag->reason).empty()) return flawOfSentence(tag->reason);
    }
  }
  return {};
}

/// Returns what is wrong with the groups of joints; empty if nothing is wrong.
std::string flawOfGroups(const std::string& srdf) {
  static const RobotModel model = chain();
  static const std::size_t joints = Kinematics(model).variables().size();
  try {
    const JointGroups groups = readJointGroups(srdf);
    for (const JointGroup& group : groups.groups) {
      try {
        const auto variables = variablesOf(group.name, groups, model);
        if (variables && (variables->empty() || variables->size() > joints)) return "a group has wrong variables";
      } catch (const Refusal& refusal) {
        if (!flawOfRefusal(refusal).empty()) return flawOfRefusal(refusal);
      }
    }
  } catch (const Refusal& refusal) {
    return flawOfRefusal(refusal);
  }
  return {};
}

}  // namespace

FuzzResult fuzzSrdf(std::string_view input) {
  const std::string text(input);
  try {
    const std::string flaw = flawOfRules(readSrdf(text), text);
    return {true, flaw.empty() ? flawOfGroups(text) : flaw};
  } catch (const Refusal& refusal) {
    return {false, flawOfRefusal(refusal)};
  }
}

}  // namespace test
}  // namespace hgrid
