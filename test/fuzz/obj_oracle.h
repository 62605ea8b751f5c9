// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hgrid {
namespace test {

/// Returns the words of each line of an OBJ file, without empty lines at its end. Blanks, tabs, vertical tabs and form
/// feeds separate words. A line that ends with a backslash and its next line are one line. Does not use the product's
/// functions.
std::vector<std::vector<std::string>> wordsOfObj(std::string_view text);

}  // namespace test
}  // namespace hgrid
