// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string>

namespace hgrid {
namespace test {

/// Returns the path of a program or library in the devel space whose file a test should use.
///
/// This is normally the devel space of the test itself. If the environment variable HGRID_TEST_DEVEL is set, it names
/// another one. So the same test programs also test a node that was built with a sanitizer.
/// @param path  path in the devel space of the test, with one folder "lib" in it
inline std::string built(const std::string& path) {
  const char* devel = std::getenv("HGRID_TEST_DEVEL");
  return devel == nullptr ? path : devel + path.substr(path.rfind("/lib/"));
}

/// Returns by how much the memory of the node may grow while it refuses bad input [kB]. A node that was built with a
/// sanitizer needs several times as much memory. It also reads the debug information of all libraries when it describes
/// a data race, even one that it then does not report.
inline std::size_t mostGrowth(std::size_t kilobytes) {
  return std::getenv("HGRID_TEST_DEVEL") == nullptr ? kilobytes : 60 * kilobytes;
}

}  // namespace test
}  // namespace hgrid
