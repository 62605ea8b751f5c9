// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace test {

/// Flat, thin, tiny, huge, with triangles or vertices that are none, or as others are.
Shape strangeShape(Random& random);

/// Two of them: touching, deep, one in the middle of the other, or anywhere; near the origin or far from it.
Case strangeCase(Random& random);

}  // namespace test
}  // namespace hgrid
