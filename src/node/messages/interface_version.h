// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

namespace hgrid {

/// Version of the messages and services, as Status.interface_version. Raise it by one whenever one of them changes; a
/// test (interface_version_unit_test) notices that.
inline constexpr std::uint32_t kInterfaceVersion = 1;

}  // namespace hgrid
