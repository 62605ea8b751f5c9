// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <utility>

#include "node/health/ledger.h"

namespace hgrid {

/// Calls `work`, the function that does all the work of a callback. Every callback of roscpp, of a timer or of a tick
/// must do its work in this way, because an exception that leaves a callback ends the process.
///
/// An exception of any type is counted as "<where>.<CODE>" and logged (see Ledger::fault()).
/// @returns why the work failed; nullopt if it did not throw
template <class Work>
std::optional<Refusal> guarded(Ledger& ledger, const char* where, Work&& work) noexcept {
  try {
    std::forward<Work>(work)();
    return std::nullopt;
  } catch (...) {
    return ledger.fault(where);
  }
}

}  // namespace hgrid
