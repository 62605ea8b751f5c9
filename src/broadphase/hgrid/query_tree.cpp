// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/query_tree.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "geometry/infinity.h"

namespace hgrid {
namespace {

constexpr std::uint32_t kLeaf = kernels::TreeBlock::kBoxes;         // largest number of boxes in a leaf
constexpr std::uint32_t kFan = kernels::TreeBlock::kBoxes;          // nodes below a node with one block
constexpr std::uint32_t kWideFan = 2 * kernels::TreeBlock::kBoxes;  // nodes below a node with two blocks
constexpr std::uint32_t kFull = kFan * kLeaf;                       // most boxes below a node with one block of leaves
constexpr std::uint32_t kWide = kWideFan * kLeaf;                   // most boxes below a node with two blocks of leaves
// Nodes from this depth on are divided at medians. So each has at most an eighth of the boxes above it, or at most
// kFull, and 2^30 boxes have at most 7 more levels until kWide boxes are left, then a node above leaves and a leaf.
constexpr int kDepthByArea = 8;
static_assert(kDepthByArea + 7 + 2 <= kernels::BoxTree::kMostDepth, "the depth is bounded");

struct Item {
  kernels::Box box;
  ProxyId id;
  /// Returns the coordinate of the center.
  float center(int axis) const { return 0.5f * box.min[axis] + 0.5f * box.max[axis]; }
};

/// The bounds of some boxes, and those of their centers.
struct Bounds {
  kernels::Box box = {{kFloatInfinity, kFloatInfinity, kFloatInfinity},
                      {-kFloatInfinity, -kFloatInfinity, -kFloatInfinity}};
  kernels::Box centers = box;

  void add(const Item& item) {
    for (int axis = 0; axis < 3; ++axis) {
      const float center = item.center(axis);
      box.min[axis] = std::min(box.min[axis], item.box.min[axis]);
      box.max[axis] = std::max(box.max[axis], item.box.max[axis]);
      centers.min[axis] = std::min(centers.min[axis], center);
      centers.max[axis] = std::max(centers.max[axis], center);
    }
  }
  void add(const Bounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], other.box.min[axis]);
      box.max[axis] = std::max(box.max[axis], other.box.max[axis]);
      centers.min[axis] = std::min(centers.min[axis], other.centers.min[axis]);
      centers.max[axis] = std::max(centers.max[axis], other.centers.max[axis]);
    }
  }
  double extent(int axis) const { return static_cast<double>(centers.max[axis]) - centers.min[axis]; }
  /// Returns the axis on which the centers are spread most.
  int longestAxis() const {
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis) longest = extent(axis) > extent(longest) ? axis : longest;
    return longest;
  }
  /// Returns the largest magnitude of a coordinate [m].
  float largest() const {
    float largest = 0.0f;
    for (int axis = 0; axis < 3; ++axis) largest = std::max({largest, -box.min[axis], box.max[axis]});
    return largest;
  }
  /// Returns half of the surface area [m²].
  double area() const {
    const double x = static_cast<double>(box.max[0]) - box.min[0], y = static_cast<double>(box.max[1]) - box.min[1],
                 z = static_cast<double>(box.max[2]) - box.min[2];
    return x * y + y * z + z * x;
  }
};

/// A range of items with their bounds.
struct Part {
  std::uint32_t begin, end;
  Bounds bounds;
  std::uint32_t size() const { return end - begin; }
};

std::uint32_t leavesFor(std::uint32_t boxes) { return (boxes + kLeaf - 1) / kLeaf; }

class Builder {
 public:
  Builder(std::vector<Item>& items, std::vector<kernels::TreeBlock>& inner, std::vector<kernels::TreeBlock>& leaves)
      : items_(items), inner_(inner), leaves_(leaves) {}

  /// Returns the range of the items begin .. end - 1, with their bounds.
  Part partOf(std::uint32_t begin, std::uint32_t end) const {
    Part part{begin, end, {}};
    for (std::uint32_t i = begin; i < end; ++i) part.bounds.add(items_[i]);
    return part;
  }

  /// Adds the nodes for a part. Returns the topmost of them.
  std::uint32_t build(const Part& part, int depth) {
    if (part.size() <= kLeaf) return addLeaf(part);
    std::array<Part, kWideFan> parts;
    std::uint32_t count = 0;
    if (part.size() > kWide) {
      count = divide(part, depth, parts);
    } else {
      splitEvenly(part, kLeaf, parts, count);
    }
    const std::uint32_t blocks = (count + kFan - 1) / kFan, first = static_cast<std::uint32_t>(inner_.size());
    inner_.resize(first + blocks, blank());
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t below = build(parts[i], depth + 1);
      put(inner_[first + i / kFan], i % kFan, parts[i].bounds.box, below);
    }
    return first << kernels::BoxTree::kShift | (blocks > 1 ? kernels::BoxTree::kTwoBlocks : 0u);
  }

 private:
  static kernels::TreeBlock blank() {
    kernels::TreeBlock block{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::fill_n(block.bounds[axis], kFan, kFloatInfinity);
      std::fill_n(block.bounds[axis + 3], kFan, -kFloatInfinity);
    }
    return block;
  }
  static void put(kernels::TreeBlock& block, std::uint32_t lane, const kernels::Box& box, std::uint32_t below) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.bounds[axis][lane] = box.min[axis];
      block.bounds[axis + 3][lane] = box.max[axis];
    }
    block.below[lane] = below;
  }
  std::uint32_t addLeaf(const Part& part) {
    std::sort(items_.begin() + part.begin, items_.begin() + part.end,
              [](const Item& a, const Item& b) { return a.id < b.id; });  // so that answers are nearly sorted
    kernels::TreeBlock block = blank();
    for (std::uint32_t i = part.begin; i < part.end; ++i) put(block, i - part.begin, items_[i].box, items_[i].id);
    leaves_.push_back(block);
    return static_cast<std::uint32_t>(leaves_.size() - 1) << kernels::BoxTree::kShift | kernels::BoxTree::kLeaf;
  }

  /// Sorts the items of a part so that the centers before position `middle` are not greater than those from it on.
  void partition(const Part& part, std::uint32_t middle) {
    const int axis = part.bounds.longestAxis();
    std::nth_element(items_.begin() + part.begin, items_.begin() + middle, items_.begin() + part.end,
                     [axis](const Item& a, const Item& b) { return a.center(axis) < b.center(axis); });
  }

  /// Divides a part into parts of `each` boxes; the last one may have fewer.
  void splitEvenly(const Part& part, std::uint32_t each, std::array<Part, kWideFan>& parts, std::uint32_t& count) {
    if (part.size() <= each) {
      parts[count++] = part;
      return;
    }
    const std::uint32_t middle = part.begin + (part.size() + each - 1) / each / 2 * each;
    partition(part, middle);
    splitEvenly(partOf(part.begin, middle), each, parts, count);
    splitEvenly(partOf(middle, part.end), each, parts, count);
  }

  /// Returns whether to divide the root into more than these parts. A second block of the root takes time in each
  /// query. It saves more time if many queries visit nodes below the root: a long line through the root is expected to
  /// meet `area of the parts / area of the root` parts.
  static bool isWorthSecondBlock(const Part& root, const std::array<Part, kWideFan>& parts, std::uint32_t count) {
    constexpr double kOften = 0.3;  // measured: queries took longer in a world with 0.28, and less time with 0.34
    double area = 0.0;
    for (std::uint32_t i = 0; i < count; ++i) area += parts[i].bounds.area();
    return area >= kOften * root.bounds.area();
  }

  /// Divides a part into up to 16 parts, or 32 if it is the root and they save time. Always splits the part with the
  /// largest cost by the surface area heuristic, or below kDepthByArea halves the largest part. Does not split parts
  /// whose leaves need only one block.
  std::uint32_t divide(const Part& part, int depth, std::array<Part, kWideFan>& parts) {
    const bool by_area = depth < kDepthByArea;
    parts[0] = part;
    std::uint32_t count = 1;
    for (; count < kWideFan; ++count) {
      if (count == kFan && !(depth == 0 && isWorthSecondBlock(part, parts, count))) break;
      Part* next = nullptr;
      std::pair<double, std::uint32_t> most;  // cost and size, because all costs may be 0
      for (std::uint32_t i = 0; i < count; ++i) {
        if (parts[i].size() <= kFull) continue;
        const std::pair<double, std::uint32_t> cost(by_area ? parts[i].bounds.area() * parts[i].size() : 0.0,
                                                    parts[i].size());
        if (next != nullptr && !(most < cost)) continue;
        next = &parts[i];
        most = cost;
      }
      if (next == nullptr) break;
      parts[count] = by_area ? splitByArea(*next) : splitAtMedian(*next);
    }
    return count;
  }

  /// Halves a part. The part keeps the first half. Returns the second half.
  Part splitAtMedian(Part& part) {
    const std::uint32_t middle = part.begin + part.size() / 2;
    partition(part, middle);
    const Part second = partOf(middle, part.end);
    part = partOf(part.begin, middle);
    return second;
  }

  /// Splits a part where the sum of area * leaves of the two halves is smallest. The part keeps the first half. Returns
  /// the second half.
  Part splitByArea(Part& part) {
    constexpr int kBins = 16;
    const int axis = part.bounds.longestAxis();
    if (!(part.bounds.extent(axis) > 0.0)) return splitAtMedian(part);
    const double low = part.bounds.centers.min[axis], scale = kBins / part.bounds.extent(axis);
    const auto binOf = [=](const Item& item) {
      return std::min(static_cast<int>((static_cast<double>(item.center(axis)) - low) * scale), kBins - 1);
    };
    struct Bin {
      Bounds bounds;
      std::uint32_t boxes = 0;
      void add(const Bin& other) {
        bounds.add(other.bounds);
        boxes += other.boxes;
      }
      double cost() const { return bounds.area() * leavesFor(boxes); }
    };
    std::array<Bin, kBins> bins;
    for (std::uint32_t i = part.begin; i < part.end; ++i) {
      Bin& bin = bins[static_cast<std::size_t>(binOf(items_[i]))];
      bin.bounds.add(items_[i]);
      ++bin.boxes;
    }
    std::array<Bin, kBins> after = bins;  // each bin together with those after it
    for (std::size_t i = kBins - 1; i-- > 0;) after[i].add(after[i + 1]);
    Bin before, first, second;
    double least = -1.0;
    int last = 0;  // the last bin of the first half
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      before.add(bins[i]);
      if (before.boxes == 0 || after[i + 1].boxes == 0) continue;
      const double cost = before.cost() + after[i + 1].cost();
      if (least >= 0.0 && !(cost < least)) continue;
      least = cost;
      last = static_cast<int>(i);
      first = before;
      second = after[i + 1];
    }
    if (least < 0.0) return splitAtMedian(part);
    std::partition(items_.begin() + part.begin, items_.begin() + part.end,
                   [&](const Item& item) { return binOf(item) <= last; });
    const std::uint32_t middle = part.begin + first.boxes, end = part.end;
    part = {part.begin, middle, first.bounds};
    return {middle, end, second.bounds};
  }

  std::vector<Item>& items_;
  std::vector<kernels::TreeBlock>&inner_, &leaves_;
};

}  // namespace

void QueryTree::build(const Layer& layer) {
  std::vector<Item> items;
  items.reserve(layer.size());
  for (std::uint32_t i = 0; i < layer.size(); ++i) {
    if (layer.isWithdrawn(i)) continue;
    const Aabb box = layer.boxAt(i);
    items.push_back({{{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}}, layer.idAt(i)});
  }
  inner_.clear();
  leaves_.clear();
  leaves_.reserve(items.size() / kLeaf + items.size() / 128 + 1);
  Builder builder(items, inner_, leaves_);
  const Part all = builder.partOf(0, static_cast<std::uint32_t>(items.size()));
  const std::uint32_t root = builder.build(all, 0);
  inner_.shrink_to_fit();
  leaves_.shrink_to_fit();
  // A sphere is tested with an allowance of 1e-12 of its largest coordinate (touchingDistance()). If it touches a box,
  // this coordinate is at most the largest one of the boxes, plus its radius.
  view_ = {inner_.data(), leaves_.data(), root, 4e-12f * all.bounds.largest() + 1e-37f};
}

void QueryTree::checkInvariants(const Layer& layer) const {
  const auto require = [](bool holds, const char* invariant) {
    if (!holds) throw std::logic_error(std::string("QueryTree: this invariant is violated: ") + invariant);
  };
  std::map<ProxyId, Aabb> missing;
  for (std::uint32_t i = 0; i < layer.size(); ++i) {
    if (!layer.isWithdrawn(i)) missing[layer.idAt(i)] = layer.boxAt(i);
  }
  const std::function<void(std::uint32_t, const std::vector<kernels::Box>&)> check =
      [&](std::uint32_t node, const std::vector<kernels::Box>& around) {
        require(around.size() < kernels::BoxTree::kMostDepth, "the depth is bounded");
        const bool leaf = (node & kernels::BoxTree::kLeaf) != 0;
        const std::uint32_t first = node >> kernels::BoxTree::kShift;
        const std::uint32_t last = first + ((node & kernels::BoxTree::kTwoBlocks) != 0 ? 1 : 0);
        const bool only_leaves = last > first && !around.empty();
        for (std::uint32_t block = first; block <= last; ++block) {
          for (std::uint32_t lane = 0; lane < kFan; ++lane) {
            const Aabb box = boxIn((leaf ? leaves_ : inner_)[block], lane);
            if (!(box.min.array() <= box.max.array()).all()) {
              require(box.min.minCoeff() == kFloatInfinity && box.max.maxCoeff() == -kFloatInfinity,
                      "unused lanes are empty");
              continue;
            }
            for (const kernels::Box& outer : around) require(contains(outer, box), "a node contains what is below it");
            if (leaf) {
              const auto stored = missing.find(leaves_[block].below[lane]);
              require(stored != missing.end(), "each box of the tree is in the layer, and in the tree only once");
              require(stored->second == box, "the boxes of the tree are those of the layer");
              missing.erase(stored);
            } else {
              std::vector<kernels::Box> with = around;
              with.push_back({{box.min[0], box.min[1], box.min[2]}, {box.max[0], box.max[1], box.max[2]}});
              const std::uint32_t below = inner_[block].below[lane];
              require(!only_leaves || (below & kernels::BoxTree::kLeaf) != 0,
                      "below a node with two blocks, except the root, are only leaves");
              check(below, with);
            }
          }
        }
      };
  check(view_.root, {});
  require(missing.empty(), "each box of the layer is in the tree");
}

}  // namespace hgrid
