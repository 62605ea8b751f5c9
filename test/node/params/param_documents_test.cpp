// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "src/node/params/params.h"

namespace hgrid {
namespace test {
namespace {

/// Expects that a file of the project contains the generated text. If HGRID_WRITE_PARAMS is set, first writes the file.
void expectGenerated(const std::string& name, const std::string& text) {
  const std::string path = std::string(HGRID_PROJECT_DIR) + "/" + name;
  if (std::getenv("HGRID_WRITE_PARAMS") != nullptr) std::ofstream(path, std::ios::binary) << text;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream held;
  held << file.rdbuf();
  EXPECT_EQ(held.str(), text) << name << " must equal the generated text, byte for byte. To write it again, run\n"
                              << "HGRID_WRITE_PARAMS=1 devel/lib/hgrid_proximity/parts_unit_test "
                              << "--gtest_filter='ParamDocuments.*'";
}

TEST(ParamDocuments, TheYamlFileShowsEveryParameterWithItsDefault) {
  expectGenerated("config/params.yaml", paramsAsYaml());
}

TEST(ParamDocuments, ThePageShowsEveryParameterWithItsDefault) {
  expectGenerated("doc/parameters.md", paramsAsMarkdown());
}

TEST(ParamDocuments, ThePageShowsNamesOfParametersAsCode) {
  EXPECT_NE(paramsAsMarkdown().find("it must be at most `~margin`, even if pairs"), std::string::npos);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
