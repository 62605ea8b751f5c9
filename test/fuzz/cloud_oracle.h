// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>

#include "hgrid_proximity/adapters/point_cloud.h"

namespace hgrid {
namespace test {

/// Decodes the bytes of a PointCloud2 message one by one. Does not use the product's code.
/// @returns the points; nullopt if the message is not valid or its points cannot be read
std::optional<PointCloud> slowlyDecoded(const std::string& message);

}  // namespace test
}  // namespace hgrid
