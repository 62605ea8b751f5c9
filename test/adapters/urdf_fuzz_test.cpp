// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Reads randomly damaged descriptions. The result must be a refusal, or a model with finite numbers in which every
// <collision> is either a shape or listed as unreadable.
#include <gtest/gtest.h>

#include "hgrid_proximity/adapters/srdf.h"
#include "test/adapters/mutation.h"
#include "test/adapters/urdf_oracle.h"
#include "test/adapters/urdf_texts.h"
#include "test/fuzz/seeds.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

const std::vector<std::string>& words() {
  static const std::vector<std::string> all = {"nan",
                                               "inf",
                                               "-inf",
                                               "1e308",
                                               "1e300",
                                               "-1",
                                               "0",
                                               "1,5",
                                               "<",
                                               ">",
                                               "/>",
                                               "\"",
                                               "'",
                                               "&",
                                               "&lt;",
                                               "&#0;",
                                               "&#x10ffff;",
                                               "<!--",
                                               "-->",
                                               "<![CDATA[",
                                               "]]>",
                                               "<?",
                                               "?>",
                                               "<!DOCTYPE x>",
                                               "<collision>",
                                               "</collision>",
                                               "<collision/>",
                                               "<link name=\"x\">",
                                               "</link>",
                                               "<link name=\"base\"/>",
                                               "<robot>",
                                               "</robot>",
                                               "<geometry/>",
                                               "<sphere radius=\"1\"/>",
                                               "<origin xyz=\"1 2 3\"/>",
                                               "type=\"fixed\"",
                                               "name=\"base\"",
                                               "type=\"floating\"",
                                               "\xff\xfe",
                                               "\xc3",
                                               std::string(1, '\0'),
                                               "\xef\xbb\xbf",
                                               "9999999999999999999999",
                                               "0x1p3",
                                               "1 2 3 4 5 6 7 8"};
  return all;
}

std::string smallRobot() {
  return robot(link("base", collision("<box size=\"1 2 3\"/>", "<origin xyz=\"0.1 0.2 0.3\" rpy=\"1 2 3\"/>") +
                                collision("<sphere radius=\"0.5\"/>")) +
               link("arm", collision("<mesh filename=\"package://p/tetrahedron.stl\" scale=\"1 2 -3\"/>")) +
               link("hand", collision("<cylinder radius=\"0.1\" length=\"0.2\"/>")) + link("tip") +
               joint("j1", "base", "arm", "revolute",
                     "<axis xyz=\"0 1 0\"/><limit lower=\"-1\" upper=\"1\" velocity=\"2\" effort=\"3\"/>") +
               joint("j2", "arm", "hand", "prismatic",
                     "<origin xyz=\"0 0 1\"/><limit lower=\"0\" upper=\"1\" velocity=\"2\" effort=\"3\"/>"
                     "<mimic joint=\"j1\" multiplier=\"2\"/>") +
               joint("j3", "hand", "tip"));
}

TEST(UrdfFuzz, ADamagedDescriptionIsACompleteModelOrRefused) {
  const std::string text = smallRobot();
  ASSERT_EQ(accountedFor(read(text)), 4u);
  int read_anyway = 0;
  const int count = countFromEnvironment("HGRID_TEST_MUTATIONS", 2000);
  for (int seed = 0; seed < count; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const std::string harmed = mutated(text, words(), random);
    try {
      const RobotModel model = read(harmed);
      ++read_anyway;
      EXPECT_EQ(flawOf(model, harmed), "");
    } catch (const Refusal& refusal) {
      EXPECT_NE(refusal.code(), Code::ok);
      EXPECT_STRNE(refusal.what(), "");
    }
    if (HasFailure()) FAIL() << "seed " << seed << "\n" << harmed;
  }
  EXPECT_GT(read_anyway, count / 20) << "the damage is too strong: too few texts can be read";
  EXPECT_LT(read_anyway, count) << "the damage is too weak: all texts can be read";
}

TEST(UrdfFuzz, ADamagedSrdfGivesRulesOrIsRefused) {
  const std::string text = fileText(ownData() + "/robots/traits.srdf");
  const RobotModel model = read(smallRobot());
  int read_anyway = 0;
  for (int seed = 0; seed < 2000; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const std::string harmed = mutated(text, words(), random);
    try {
      const LinkRules rules = readSrdf(harmed);
      ++read_anyway;
      std::vector<std::string> warnings;
      const LinkMatrix matrix(model, rules, warnings);
      EXPECT_EQ(matrix.origin(0, 0), Origin::self);
    } catch (const Refusal& refusal) {
      EXPECT_STRNE(refusal.what(), "");
    }
    if (HasFailure()) FAIL() << "seed " << seed << "\n" << harmed;
  }
  EXPECT_GT(read_anyway, 100);
}

TEST(UrdfFuzz, TheSeedsOfTheFuzzersAreReadCorrectly) {
  expectNoFlawInSeeds("urdf", fuzzUrdf);
  expectNoFlawInSeeds("srdf", fuzzSrdf);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
