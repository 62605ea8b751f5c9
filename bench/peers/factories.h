// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "bench/peers/peer.h"

namespace hgrid {
namespace bench {

// One factory per peer. If the library of a peer was not found, its factory is declared but not defined.
std::unique_ptr<Peer> makeBrute();
std::unique_ptr<Peer> makeFloor();
std::unique_ptr<Peer> makeSweep();
std::unique_ptr<Peer> makeFclTree();
std::unique_ptr<Peer> makeFclTreeArray();
std::unique_ptr<Peer> makeFclSaP();
std::unique_ptr<Peer> makeFclSSaP();
std::unique_ptr<Peer> makeFclSpatialHash();
std::unique_ptr<Peer> makeBulletDbvt();
std::unique_ptr<Peer> makeBulletAxisSweep();
std::unique_ptr<Peer> makeOdeHash();
std::unique_ptr<Peer> makeOdeSap();
std::unique_ptr<Peer> makeCgal();
std::unique_ptr<Peer> makeBoostRtree();
std::unique_ptr<Peer> makeEmbree();
std::unique_ptr<Peer> makeBox3d();
std::unique_ptr<Peer> makeJolt();

/// Returns whether this processor can run the peer of makeSweep().
bool canSweep();

}  // namespace bench
}  // namespace hgrid
