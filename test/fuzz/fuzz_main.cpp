// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The entry point of each libFuzzer program. HGRID_FUZZED is the name of the function that reads one input (targets.h).
// test/fuzz/run builds the programs.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "test/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string flaw = hgrid::test::HGRID_FUZZED({reinterpret_cast<const char*>(data), size}).flaw;
  if (!flaw.empty()) {
    std::fprintf(stderr, "%s\n", flaw.c_str());
    std::abort();
  }
  return 0;
}
