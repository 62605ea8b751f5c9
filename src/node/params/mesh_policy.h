// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>

#include "hgrid_proximity/adapters/mesh.h"
#include "node/params/params.h"

namespace hgrid {

/// Returns the settings for reading the mesh files of robots and obstacles.
/// @param cancelled  called repeatedly while a file is read; once it returns true, reading stops
MeshPolicy meshPolicy(const Params& params, const std::function<bool()>& cancelled);

}  // namespace hgrid
