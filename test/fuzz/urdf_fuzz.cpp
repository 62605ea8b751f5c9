// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/urdf_oracle.h"
#include "test/adapters/urdf_texts.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {

FuzzResult fuzzUrdf(std::string_view input) {
  const std::string text(input);
  try {
    return {true, flawOf(read(text), text)};
  } catch (const Refusal& refusal) {
    return {false, flawOfRefusal(refusal)};
  }
}

}  // namespace test
}  // namespace hgrid
