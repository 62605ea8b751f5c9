// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <utility>

#include "node/diagnostics/ledger.h"

namespace hgrid {

/// Calls `deed`, which is the content of a callback. Every callback that roscpp, a timer or a tick calls must use this
/// function, because an exception that leaves a callback ends the process.
///
/// An exception of any type is counted as "<where>.<CODE>" and logged (see Ledger::fault()).
/// @returns why the deed failed; nullopt if it did not throw
template <class Deed>
std::optional<Refusal> guarded(Ledger& ledger, const char* where, Deed&& deed) noexcept {
  try {
    std::forward<Deed>(deed)();
    return std::nullopt;
  } catch (...) {
    return ledger.fault(where);
  }
}

}  // namespace hgrid
