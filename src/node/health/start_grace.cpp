// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/health/start_grace.h"

namespace hgrid {

bool StartGrace::excuses(Code code, Time now) const {
  return now < end_ && (code == Code::not_ready || code == Code::unknown_frame || code == Code::extrapolation);
}

void StartGrace::refuse(Ledger& ledger, const std::string& where, const Refusal& refusal) const {
  if (excuses(refusal.code(), std::chrono::steady_clock::now())) {
    ledger.count(where + "." + name(refusal.code()));
  } else {
    ledger.refuse(where, refusal);
  }
}

}  // namespace hgrid
