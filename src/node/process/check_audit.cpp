// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
// check_audit: repeats the audit of a file. kUsage says more.
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"
#include "node/audit/audit.h"
#include "node/audit/case_file.h"

namespace {

constexpr char kUsage[] =
    "usage: rosrun hgrid_proximity check_audit FILE\n\n"
    "Repeats the audit of a file that the node wrote to ~audit_folder, and prints the differences, one per line. "
    "Needs\n"
    "no ROS master and ignores ROS remappings.\n\n"
    "options:\n"
    "  -h, --help  print this text and end\n\n"
    "exit codes:\n"
    "  0  there is no difference\n"
    "  1  there are differences\n"
    "  2  an argument is wrong, or the file cannot be read\n";

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--help" || word == "-h") return std::fputs(kUsage, stdout), 0;
    if (word.find(":=") == std::string::npos) words.push_back(word);
  }
  if (words.size() != 1 || words.front().rfind('-', 0) == 0) {
    std::fputs("check_audit: the only argument must be the path of a file; --help says more\n", stderr);
    return 2;
  }
  std::ifstream file(words.front());
  if (!file) {
    std::fprintf(stderr, "the file '%s' cannot be opened\n", words.front().c_str());
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
