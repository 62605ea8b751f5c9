// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>

namespace hgrid {

class World;
struct Tick;

/// Changes the world at the beginning of a tick, waits until that tick, ~bodies and ~rules are published, and returns
/// that tick.
/// @throws whatever the change throws; Refusal busy if no tick makes the change in time
using ChangeWorld = std::function<std::shared_ptr<const Tick>(const std::function<void(World&)>& change)>;

/// Waits until the changes of the world are on disk, if ~state_folder is set. @returns whether they are
using WaitUntilStored = std::function<bool()>;

}  // namespace hgrid
