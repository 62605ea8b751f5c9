// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>

#include <string_view>

namespace hgrid {
namespace test {

/// Reads a parameter value from text that resembles JSON, such as `{rate: 5.0, required: ['robot/*'], threads: 2}`.
///
/// Any text gives a value, so that every input of a fuzzer is useful. Missing ends and commas do not matter. A number
/// with one of the characters `.enif` is a double. `D` is a date, `B` binary data, and `?` a value without a type.
XmlRpc::XmlRpcValue paramsFrom(std::string_view text);

}  // namespace test
}  // namespace hgrid
