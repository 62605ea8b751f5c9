// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "history/kept_parts.h"

namespace hgrid {
namespace {

// [bytes] A mesh as a solid has about two nodes of a tree per triangle.
constexpr std::size_t kPerVertex = 100, kPerTriangle = 800;
constexpr std::size_t kPerPart = 64;                        // [bytes] overhead of a shared object
constexpr std::size_t kCubes = (Voxel::kLevels + 1) * 256;  // [bytes] MapCells::cubes

std::size_t bytesOf(const TriangleMesh& mesh) {
  return mesh.vertices.size() * kPerVertex + mesh.triangles.size() * kPerTriangle;
}

std::size_t bytesOf(const LinkMatrix& links) { return links.size() * links.size(); }

std::size_t bytesOf(const Body& body) {
  std::size_t bytes = sizeof(Body) + kPerPart + body.name.capacity() + body.frame.capacity() + body.note.capacity() +
                      body.robot.capacity() + body.group.capacity();
  for (const BodyShape& shape : body.shapes) bytes += sizeof(BodyShape) + 2 * kPerPart + shape.resource.capacity();
  return bytes;
}

/// Returns the memory of a structure without its bodies.
std::size_t bytesOf(const Structure& structure) {
  std::size_t bytes = sizeof(Structure) + kPerPart + structure.filter.bytes() + structure.pair_margins.bytes();
  bytes += structure.bodies.size() * (sizeof(std::shared_ptr<const Body>) + sizeof(BodyId) + sizeof(double));
  bytes += sizeof(std::uint32_t) *
           (structure.first_proxy.capacity() + structure.body_of_proxy.capacity() + structure.planes.capacity() +
            structure.maps.capacity() + structure.source_of.capacity());
  for (const auto* names : {&structure.sources, &structure.absent}) {
    for (const std::string& name : *names) bytes += sizeof(std::string) + name.capacity();
  }
  return bytes;
}

}  // namespace

/// Changes the entry of a part, and corrects the sum of the bytes.
template <class Change>
void KeptParts::edit(const void* key, std::size_t bytes, const Change& change) {
  Part& part = parts_[key];
  const auto counted = [&] { return part.uses > 0 && !part.newest ? part.bytes : 0; };
  bytes_ -= counted();
  part.bytes = bytes;
  change(part);
  bytes_ += counted();
  if (part.uses == 0 && !part.newest) parts_.erase(key);
}

/// Changes the entries of a structure and of its bodies with their meshes.
template <class Change>
void KeptParts::editStructure(const Structure& structure, const Change& change) {
  edit(&structure, bytesOf(structure), change);
  for (const Body& body : structure.bodies) {
    edit(&body, bytesOf(body), change);
    if (body.links) edit(body.links.get(), bytesOf(*body.links), change);
    for (const BodyShape& shape : body.shapes) {
      const TriangleMesh* mesh = shape.shape.mesh().get();
      if (mesh != nullptr) edit(mesh, bytesOf(*mesh), change);
    }
  }
}

template <class Change>
void KeptParts::editCells(const Cells& cells, const Change& change) {
  for (const auto& one : cells) {
    if (!one) continue;
    if (one->grid) edit(one->grid.get(), sizeof(MapCells) + kCubes + kPerPart + one->grid->bytes(), change);
    if (one->unmapped) edit(one->unmapped.get(), kPerPart + one->unmapped->cells.bytes(), change);
  }
}

void KeptParts::use(const std::shared_ptr<const Structure>& structure, const Cells& cells) {
  const auto add = [](Part& part) { ++part.uses; };
  if (ticks_of_[structure.get()]++ == 0) editStructure(*structure, add);
  editCells(cells, add);
}

void KeptParts::release(const std::shared_ptr<const Structure>& structure, const Cells& cells) {
  const auto subtract = [](Part& part) { --part.uses; };
  editCells(cells, subtract);
  const auto known = ticks_of_.find(structure.get());
  if (--known->second > 0) return;
  ticks_of_.erase(known);
  editStructure(*structure, subtract);
}

void KeptParts::setNewest(const std::shared_ptr<const Structure>& structure, const Cells& cells) {
  const auto leave = [](Part& part) { part.newest = false; };
  const auto enter = [](Part& part) { part.newest = true; };
  if (structure != newest_) {
    if (newest_) editStructure(*newest_, leave);
    newest_ = structure;
    editStructure(*newest_, enter);
  }
  if (cells != newest_cells_) {
    editCells(newest_cells_, leave);
    newest_cells_ = cells;
    editCells(newest_cells_, enter);
  }
}

}  // namespace hgrid
