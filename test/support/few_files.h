// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace hgrid {
namespace test {

/// Whether FewFiles can be used. A sanitizer opens files of its own, and reports faults if it cannot.
inline bool canLimitFiles() {
#ifdef __SANITIZE_ADDRESS__
  return false;
#else
  return true;
#endif
}

/// Lets this process open only `more` further files, until it is destroyed.
class FewFiles {
 public:
  explicit FewFiles(int more) {
    getrlimit(RLIMIT_NOFILE, &before_);
    const int lowest = open("/", O_PATH | O_CLOEXEC);
    close(lowest);
    rlimit limit = before_;
    limit.rlim_cur = static_cast<rlim_t>(lowest + more);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  ~FewFiles() { setrlimit(RLIMIT_NOFILE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace test
}  // namespace hgrid
