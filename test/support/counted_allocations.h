// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A program that links counted_allocations.cpp gets an operator new that counts the allocated bytes.
#pragma once

#include <cstddef>

namespace hgrid {
namespace test {

/// Returns the total number of bytes that all threads have allocated so far.
std::size_t allocatedBytes();

}  // namespace test
}  // namespace hgrid
