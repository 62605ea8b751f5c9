// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <iostream>

namespace hgrid {
namespace test {

/// Suppresses output to std::cerr while this object exists. OctoMap prints a message there for each file that it reads.
class Silence {
 public:
  Silence() : buffer_(std::cerr.rdbuf(nullptr)) {}
  ~Silence() { std::cerr.rdbuf(buffer_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::streambuf* buffer_;
};

}  // namespace test
}  // namespace hgrid
