// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A libFuzzer target for the reader of OctoMap files and messages. test/fuzz/run builds and runs it.
#include "test/fuzz/octomap_fuzz.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string flaw = hgrid::test::readFuzzed({reinterpret_cast<const char*>(data), size}).flaw;
  if (!flaw.empty()) {
    std::fprintf(stderr, "%s\n", flaw.c_str());
    std::abort();
  }
  return 0;
}
