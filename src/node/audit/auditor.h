// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "node/audit/audit_case.h"
#include "node/audit/audit_findings.h"
#include "node/health/commons.h"
#include "node/threads/newest_only.h"

namespace hgrid {

/// Audits ticks while the node runs: ~audit_rate ticks per second. The audits run on a separate thread with the lowest
/// priority. A tick never waits for an audit.
///
/// If an audit finds a difference, the auditor logs an error and sets the status "audit" of /diagnostics to ERROR. It
/// also increases the counter "audit.different", and writes the case to a file in ~audit_folder.
class Auditor {
 public:
  /// @param commons  must outlive this object
  explicit Auditor(Commons& commons);
  ~Auditor();

  /// Returns the record that stores the messages of /tf and /tf_static; null if ~audit_rate is 0. Only the tick thread
  /// may use the record.
  TfListener* listener() { return is_on_ ? &record_ : nullptr; }
  /// Starts an audit of this tick if one is due. Only the tick thread may call this.
  void see(const std::shared_ptr<const Tick>& tick);

 private:
  struct Request {
    std::shared_ptr<const Tick> tick;
    TransformRecord::Content record;
  };
  void work(const Request& request);
  void report(const AuditCase& audited, const AuditFindings& findings);
  std::string store(const AuditCase& audited);

  Commons& commons_;
  const bool is_on_;
  const std::chrono::nanoseconds period_;
  TransformRecord record_;
  std::uint64_t epoch_ = 0;                       // tick thread only: epoch of the last tick that see() got
  std::chrono::steady_clock::time_point next_{};  // tick thread only: when the next audit is due
  std::uint64_t audits_ = 0, files_ = 0;          // audit thread only: how many audits and files were made
  std::unique_ptr<NewestOnly<Request>> worker_;   // declared last, because its thread uses the members above
};

}  // namespace hgrid
