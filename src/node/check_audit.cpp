// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// usage: rosrun hgrid_proximity check_audit FILE
//
// Repeats the audit of a file that the node wrote to ~audit_folder, and prints the differences, one per line. The exit
// code is 0 if there is none, 1 if there are some, and 2 if the file cannot be read.
#include <cstdio>
#include <fstream>

#include "hgrid_proximity/refusal.h"
#include "node/audit/audit.h"
#include "node/audit/case_file.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: rosrun hgrid_proximity check_audit FILE\n", stderr);
    return 2;
  }
  std::ifstream file(argv[1]);
  if (!file) {
    std::fprintf(stderr, "the file '%s' cannot be opened\n", argv[1]);
    return 2;
  }
  try {
    const hgrid::AuditCase audited = hgrid::readCase(file);
    const hgrid::AuditFindings findings = hgrid::audit(audited, 0);
    for (const std::string& difference : findings.differences) std::printf("%s\n", difference.c_str());
    std::printf("tick %llu: %llu poses, %llu pairs and %llu queries compared, %llu differences\n",
                static_cast<unsigned long long>(audited.sequence), static_cast<unsigned long long>(findings.poses),
                static_cast<unsigned long long>(findings.pairs), static_cast<unsigned long long>(findings.queries),
                static_cast<unsigned long long>(findings.total));
    return findings.total == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
