// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

namespace hgrid {

/// Version of the messages and services, sent as Status.interface_version. Raise it by one when any of them changes.
/// The test interface_version_unit_test fails if this was forgotten.
inline constexpr std::uint32_t kInterfaceVersion = 11;

}  // namespace hgrid
