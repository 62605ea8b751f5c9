// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace test {

/// Returns what is wrong with an error sentence: it must be printable UTF-8 of 1 .. 4000 bytes. Empty: nothing is
/// wrong.
std::string flawOfSentence(const std::string& sentence);

/// Returns what is wrong with a refusal: its code or its sentence. Empty: nothing is wrong.
std::string flawOfRefusal(const Refusal& refusal);

}  // namespace test
}  // namespace hgrid
