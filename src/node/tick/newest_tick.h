// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>

namespace hgrid {

struct Tick;

/// Returns the newest tick; null before the first one. Any thread may call it.
using NewestTick = std::function<std::shared_ptr<const Tick>()>;

}  // namespace hgrid
