// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Bodies.h>

#include "node/messages/to_messages.h"

namespace hgrid {

/// Returns the message of ~bodies: names, frames and shapes of all bodies of a tick.
msg::Bodies bodiesMessage(const Tick& tick);

}  // namespace hgrid
