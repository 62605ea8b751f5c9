// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Draws the cells or nodes of each partition of the book over the same small world. Each picture comes from a real run.
// usage: partition_drawings FOLDER
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

#include "bench/workload/random.h"
#include "hgrid_proximity/broadphase/rooms.h"
#include "hgrid_proximity/partitions/partitions.h"
#include "partitions/partition.h"

namespace hgrid {
namespace {

constexpr double kScale = 40.0, kSide = 10.0, kBorder = 8.0;  // [pixel/m], [m], [pixel]

/// Forty flat boxes of three sizes; half of the small ones are in one corner.
std::vector<Aabb> smallWorld() {
  bench::Random random(5);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 40; ++i) {
    const double side = i < 2 ? 2.2 : i < 10 ? 0.9 : 0.3, wide = side * random.uniform(0.5, 1.0);
    const double far = i >= 25 ? 2.5 : kSide - wide, x = random.uniform(0.1, far), y = random.uniform(0.1, far);
    const double high = side * random.uniform(0.5, 1.0);
    boxes.push_back({{float(x), float(y), 0.0f}, {float(x + wide), float(std::min(y + high, kSide)), 0.05f}});
  }
  return boxes;
}

class Picture {
 public:
  explicit Picture(const std::string& path) : out_(path) {
    const double size = kSide * kScale + 2 * kBorder;
    out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << size << "\" height=\"" << size
         << "\" viewBox=\"0 0 " << size << ' ' << size
         << "\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  }
  ~Picture() { out_ << "</svg>\n"; }
  /// Draws a rectangle, cut at the border of the picture. The y axis points up.
  void rectangle(const Aabb& box, const char* style) {
    const auto place = [](float coordinate) {
      return std::round(10.0 * kScale * std::min(std::max(double(coordinate), -0.2), kSide + 0.2)) / 10.0;
    };
    const double x = place(box.min.x()), y = place(box.min.y()), wide = place(box.max.x()) - x,
                 high = place(box.max.y()) - y;
    out_ << "<rect x=\"" << x + kBorder << "\" y=\"" << kSide * kScale - y - high + kBorder << "\" width=\"" << wide
         << "\" height=\"" << high << "\" " << style << "/>\n";
  }

 private:
  std::ofstream out_;
};

constexpr const char* kBox = "fill=\"#d9822b\" fill-opacity=\"0.55\" stroke=\"#8a4b08\" stroke-width=\"0.8\"";
constexpr const char* kRegion = "fill=\"#2b6cd9\" fill-opacity=\"0.07\" stroke=\"#2b6cd9\" stroke-width=\"1\"";
constexpr const char* kPortal = "fill=\"#2aa84a\" fill-opacity=\"0.6\" stroke=\"none\"";

void drawPartition(BroadPhaseType type, const std::vector<Aabb>& boxes, const std::string& folder) {
  const std::unique_ptr<BroadPhase> made = makeBroadPhase({type});
  const auto* partition = dynamic_cast<const book::Partition*>(made.get());
  if (partition == nullptr) return;  // how_it_works.md has a picture of HGrid
  for (ProxyId id = 0; id < boxes.size(); ++id) made->insert(id, boxes[id]);
  Picture picture(folder + "/" + name(type) + ".svg");
  std::set<std::array<float, 4>> drawn;  // regions that differ only in z are drawn once
  for (const Aabb& region : partition->drawing()) {
    if (drawn.insert({region.min.x(), region.min.y(), region.max.x(), region.max.y()}).second)
      picture.rectangle(region, kRegion);
  }
  for (const Aabb& box : boxes) picture.rectangle(box, kBox);
}

/// Draws three rooms and two doors; a box is dark if it is in more than one room.
void drawRooms(const std::vector<Aabb>& boxes, const std::string& folder) {
  const auto box = [](double x0, double y0, double x1, double y1) {
    return Eigen::AlignedBox3d(Eigen::Vector3d(x0, y0, -1), Eigen::Vector3d(x1, y1, 1));
  };
  const std::vector<Eigen::AlignedBox3d> rooms{box(0, 0, 4.8, 10), box(5, 0, 10, 4.4), box(5, 4.6, 10, 10)};
  const std::vector<Portal> doors{{{0, 1}, box(4.8, 1, 5, 2)}, {{1, 2}, box(7, 4.4, 8, 4.6)}};
  const Building building({Room::ofBox("a", rooms[0]), Room::ofBox("b", rooms[1]), Room::ofBox("c", rooms[2])}, doors);
  Picture picture(folder + "/rooms.svg");
  const auto flat = [](const Eigen::AlignedBox3d& room) {
    return Aabb{room.min().cast<float>(), room.max().cast<float>()};
  };
  for (const Eigen::AlignedBox3d& room : rooms) picture.rectangle(flat(room), kRegion);
  for (const Portal& door : doors) picture.rectangle(flat(door.opening), kPortal);
  std::vector<std::uint32_t> found;
  for (const Aabb& one : boxes) {
    building.roomsOf(one, found);
    picture.rectangle(one, found.size() > 1 ? "fill=\"#8a1c08\" fill-opacity=\"0.8\"" : kBox);
  }
}

}  // namespace
}  // namespace hgrid

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: partition_drawings FOLDER\n");
    return 2;
  }
  const std::vector<hgrid::Aabb> boxes = hgrid::smallWorld();
  for (const hgrid::BroadPhaseType type : hgrid::broadPhaseTypes()) hgrid::drawPartition(type, boxes, arguments[1]);
  hgrid::drawRooms(boxes, arguments[1]);
  return 0;
}
