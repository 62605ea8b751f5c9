// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "test/fuzz/targets.h"

namespace hgrid {
namespace test {

/// Reads all seeds of a fuzz target. Seeds are the inputs with which the fuzzer starts, and inputs that once failed. No
/// seed may show a flaw. At least two seeds must be accepted and two refused, because the fuzzer needs both kinds.
inline void expectNoFlawInSeeds(const std::string& target, FuzzResult (*read)(std::string_view)) {
  int accepted = 0, refused = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HGRID_PROJECT_DIR "/test/fuzz/" + target)) {
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    const FuzzResult result = read(bytes);
    EXPECT_EQ(result.flaw, "") << entry.path();
    ++(result.accepted ? accepted : refused);
  }
  EXPECT_GE(accepted, 2) << "too few seeds are accepted";
  EXPECT_GE(refused, 2) << "too few seeds are refused";
}

}  // namespace test
}  // namespace hgrid
