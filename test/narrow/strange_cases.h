// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace test {

/// Returns a flat, thin, tiny, huge or ordinary shape, or one with degenerate triangles or vertices.
Shape strangeShape(Random& random);

/// Returns two strange shapes that touch, overlap deeply, have equal centers or lie anywhere. They are near the origin
/// or far from it.
Case strangeCase(Random& random);

}  // namespace test
}  // namespace hgrid
