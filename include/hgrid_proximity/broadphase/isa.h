// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Instruction sets that the inner loops are compiled for. Results do not depend on the choice, to the byte.
/// Here avx2 is with FMA and BMI, avx512 with these and VL, BW, DQ; neon is that of 64-bit ARM.
enum class Isa : int { portable = 0, sse2 = 1, avx2 = 2, avx512 = 3, neon = 4 };

/// The set as a word, as in "avx2".
const char* name(Isa isa);

/// Whether this build has the set and this processor runs it; portable always.
bool isSupported(Isa isa);

/// The largest set that is supported; asked of the processor once.
Isa bestIsa();

}  // namespace hgrid
