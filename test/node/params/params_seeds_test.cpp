// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/fuzz/seeds.h"

namespace hgrid {
namespace test {
namespace {

TEST(FuzzSeeds, OfParametersAreReadCorrectly) { expectNoFlawInSeeds("params", fuzzParams); }
TEST(FuzzSeeds, OfCloudsAreReadCorrectly) { expectNoFlawInSeeds("cloud", fuzzCloud); }

}  // namespace
}  // namespace test
}  // namespace hgrid
