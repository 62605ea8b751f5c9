// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/auditor.h"

#include <pthread.h>
#include <ros/console.h>
#include <ros/file_log.h>
#include <sched.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "node/audit/audit.h"
#include "node/audit/case_file.h"
#include "node/health/guarded.h"

namespace hgrid {
namespace {

constexpr double kWindow = 2.0;           // [s] how long transforms are kept, in addition to ~limits/max_sync_wait
constexpr std::uint64_t kMostFiles = 10;  // one run of the node writes at most so many files

/// Lets the calling thread run only while no other thread needs its processor.
void runInTheBackground() {
  // A failure does no harm, because an audit works with any priority. A nice value of 19 would not be enough: other
  // threads that become ready, such as those of queries, would still wait some milliseconds.
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
}

}  // namespace

Auditor::Auditor(Commons& commons)
    : commons_(commons),
      is_on_(commons.settings.params.audit_rate > 0.0),
      period_(is_on_ ? Time(std::llround(1e9 / commons.settings.params.audit_rate)) : Time(0)),
      record_(Time(std::llround(1e9 * (kWindow + commons.settings.params.max_sync_wait))),
              static_cast<std::size_t>(commons.settings.params.tf_queue_bytes),
              static_cast<std::size_t>(commons.settings.params.max_frames)) {
  if (!is_on_) return;
  worker_ = std::make_unique<NewestOnly<Request>>([this](const Request& request) {
    if (guarded(commons_.ledger, "audit.failed", [&] { work(request); })) commons_.ledger.count("audit.skipped");
  });
}

Auditor::~Auditor() = default;

void Auditor::see(const std::shared_ptr<const Tick>& tick) {
  if (!is_on_) return;
  if (tick->epoch != epoch_) record_.forgetMoving(tick->made.ros);
  epoch_ = tick->epoch;
  if (!tick->snapshot || tick->made.steady < next_ || record_.isReading()) return;
  next_ = tick->made.steady + period_;
  worker_->give({tick, record_.content()});
}

void Auditor::work(const Request& request) {
  if (audits_ == 0) runInTheBackground();
  const std::uint64_t seed = ++audits_ * 2654435761u;
  const AuditCase audited = caseOf(*request.tick, request.record, seed, *commons_.narrow_phase);
  const AuditFindings findings = audit(audited, seed);
  commons_.ledger.count("audit.checked");
  commons_.ledger.count("audit.poses", findings.poses);
  commons_.ledger.count("audit.poses_skipped", findings.poses_skipped);
  commons_.ledger.count("audit.pairs", findings.pairs);
  commons_.ledger.count("audit.queries", findings.queries);
  if (findings.total > 0) {
    report(audited, findings);
  } else {
    commons_.health.noteAudit("");
  }
}

void Auditor::report(const AuditCase& audited, const AuditFindings& findings) {
  commons_.ledger.count("audit.different");
  const std::string sentence = "the audit of tick " + std::to_string(audited.sequence) + " found " +
                               std::to_string(findings.total) +
                               " differences; the first: " + findings.differences.front();
  const std::string where = store(audited);
  commons_.health.noteAudit(sentence + "; " + where);
  ROS_ERROR_STREAM_THROTTLE(
      1.0, sentence << "; " << where << ". Do not trust the pairs of this node, and report the difference");
}

/// Writes the case to a file. @returns a clause for a message: the path of the file, or why no file was written
std::string Auditor::store(const AuditCase& audited) {
  namespace fs = std::filesystem;
  if (files_ >= kMostFiles) return "no file was written, because this run has written " + std::to_string(files_);
  const std::string& folder = commons_.settings.params.audit_folder;
  const fs::path path = fs::path(folder.empty() ? ros::file_log::getLogDirectory() : folder) /
                        ("audit_" + std::to_string(audited.epoch) + "_" + std::to_string(audited.sequence) + ".txt");
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  std::ofstream out(path);
  writeCase(audited, out);
  out.close();
  if (!out) {
    fs::remove(path, error);
    return "its file " + path.string() + " could not be written: check ~audit_folder and the free space";
  }
  ++files_;
  return "its file is " + path.string();
}

}  // namespace hgrid
