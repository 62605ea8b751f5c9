// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Instruction sets that the inner loops are compiled for. All of them give exactly the same results.
/// `avx2` includes FMA and BMI. `avx512` includes these two and VL, BW, DQ. `neon` is the NEON of 64-bit ARM.
enum class Isa : int { portable = 0, sse2 = 1, avx2 = 2, avx512 = 3, neon = 4 };

/// Returns the name of an instruction set, such as "avx2".
const char* name(Isa isa);

/// Returns whether this build contains the instruction set and this processor supports it; always true for portable.
bool isSupported(Isa isa);

/// Returns the supported instruction set with the widest vectors. Only the first call asks the processor.
Isa bestIsa();

}  // namespace hgrid
