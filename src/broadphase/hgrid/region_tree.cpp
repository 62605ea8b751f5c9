// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/region_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "broadphase/hgrid/box_sample.h"
#include "geometry/infinity.h"
#include "geometry/rounding.h"

namespace hgrid {
namespace {

constexpr std::size_t kFewSamples = 2048;   // if there are fewer boxes than twice this number, all are samples
constexpr std::size_t kBoxesPerSample = 4;  // of very many boxes, one of each four successive boxes is a sample
// [nats] The cost of a split: kGain, plus kGainPerSample for each sample. A split is made only if the log-likelihood
// rises by more than its cost. For random samples of evenly spread boxes, the log-likelihood rises by less.
constexpr double kGainPerSample = 0.25, kGain = 40.0;
constexpr std::size_t kWorthSplitting = 80;  // boxes; fewer take so little time in one region that no split is tried
constexpr std::int32_t kBins = 32;           // number of equal parts of a group; splits between them are tried
// If a split gains less than this fraction of its cost, the samples may be spread evenly. Then further splits would be
// tried in vain.
constexpr double kLittleGain = 0.25;
// Samples are spread evenly if their cells are at most this much more crowded than the cells of random samples.
constexpr double kEvenCrowding = 1.5;

using Corner = Eigen::Array4f;  // the 4th value is 0; four values are one register

/// The number and the bounds [m] of some minimum corners.
struct CornerGroup {
  double count = 0.0;
  Corner low = Corner::Constant(kFloatInfinity), high = Corner::Constant(-kFloatInfinity);

  void add(const Corner& corner) {
    count += 1.0;
    low = low.min(corner);
    high = high.max(corner);
  }
  void add(const CornerGroup& other) {
    count += other.count;
    low = low.min(other.low);
    high = high.max(other.high);
  }
};

/// Returns the logarithm to base 2 of a positive, normal number. The error is below 0.001. Faster than std::log2(). The
/// polynomial interpolates the logarithm of the significand at four Chebyshev nodes.
double roughLog2(double number) {
  std::uint64_t bits;
  std::memcpy(&bits, &number, sizeof bits);
  const auto exponent = static_cast<std::int32_t>(bits >> 52) - 1023;
  bits = (bits & 0xfffffffffffffu) | 0x3ff0000000000000u;
  double x;  // the significand, 1 .. 2
  std::memcpy(&x, &bits, sizeof x);
  return (exponent - 2.136232) + x * (3.011162 + x * (-1.026805 + x * 0.1527003));
}

/// The best split of a group, with the statistics of both parts.
struct Split {
  std::size_t axis = 0;
  float at = 0.0f;
  bool exists = false;
  double likelihood = -std::numeric_limits<double>::infinity();  // log-likelihood of both parts
  CornerGroup below, above;
};

}  // namespace

/// Builds the tree from a sample of the boxes.
class RegionTree::Division {
 public:
  Division(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count) {
    const std::size_t stride = std::max<std::size_t>(1, std::min(kBoxesPerSample, count / kFewSamples));
    worth_splitting_ = kWorthSplitting / stride;
    samples_.reserve(count / stride + 1);
    std::array<double, 3> sides{};
    for (std::size_t i = 0; i < count; i += stride) {
      const std::size_t chosen = stride == 1 ? i : std::min(i + scatteredBelow(stride, samples_.size()), count - 1);
      const Aabb& box = boxes[ids[chosen]];
      samples_.emplace_back(box.min[0], box.min[1], box.min[2], 0.0f);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sides[axis] +=
            static_cast<double>(box.max[static_cast<Eigen::Index>(axis)]) - box.min[static_cast<Eigen::Index>(axis)];
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      side_[axis] = std::max(sides[axis] / static_cast<double>(samples_.size()), kLeastLength);
    }
  }

  RegionTree tree() {
    RegionTree tree;
    divide(0, samples_.size(), allSamples(), 0);
    tree.branches_.clear();
    tree.regions_.clear();
    kernels::Region space{};
    std::fill_n(space.low, 3, -kFloatInfinity);
    std::fill_n(space.high, 3, kFloatInfinity);
    lay(tree, 0, space);
    return tree;
  }

 private:
  /// A part of space. It is split into two parts, or it is a region.
  struct Part {
    float split = 0.0f;
    std::int32_t axis = -1;            // axis of the split; -1: the part is a region
    std::size_t below = 0, above = 0;  // indices of the two parts into which this part is split
    double likelihood = 0.0;           // log-likelihood of the samples in this part, minus the cost of the splits
  };

  /// Returns the group of all samples.
  CornerGroup allSamples() const {
    CornerGroup all;
    for (const Corner& corner : samples_) all.add(corner);
    return all;
  }

  static float coordinate(const Corner& corner, std::size_t axis) { return corner[static_cast<Eigen::Index>(axis)]; }
  /// Returns how long the bounds of a group are on an axis [m].
  static double extent(const CornerGroup& group, std::size_t axis) {
    return static_cast<double>(coordinate(group.high, axis)) - coordinate(group.low, axis);
  }

  /// Returns the volume [m^3] in which the boxes of a group are.
  double volumeOf(const CornerGroup& group) const {
    double volume = 1.0;
    for (std::size_t i = 0; i < 3; ++i) volume *= extent(group, i) + side_[i];
    return volume;
  }

  /// Returns the log-likelihood of the corners of a group, if corners are spread evenly within the bounds of the group.
  /// A summand that is the same for all divisions is left out.
  double likelihood(const CornerGroup& group) const {
    if (group.count == 0.0) return 0.0;
    return group.count * std::log(group.count / volumeOf(group));
  }
  /// Like likelihood(), but less exact and faster. The group must not be empty.
  double roughLikelihood(const CornerGroup& group) const {
    constexpr double kLogOf2 = 0.6931471805599453;
    return kLogOf2 * group.count * roughLog2(group.count / volumeOf(group));
  }

  /// Returns the cost of a split of a group.
  static double cost(const CornerGroup& group) { return kGainPerSample * group.count + kGain; }

  /// Returns an upper bound of the gain that any number of splits of a group can have: no volume is below that of a
  /// mean box.
  double mostGain(const CornerGroup& group) const {
    double ratio = 1.0;
    for (std::size_t i = 0; i < 3; ++i) ratio *= (extent(group, i) + side_[i]) / side_[i];
    return group.count * std::log(ratio);
  }

  /// Adds a part with the samples begin .. end - 1. Splits the part if the gain is more than the cost of the split.
  /// @param group  number and bounds of these samples
  /// @returns the index of the part
  std::size_t divide(std::size_t begin, std::size_t end, const CornerGroup& group, int depth) {
    const std::size_t number = parts_.size();
    parts_.emplace_back();
    const double alone = likelihood(group);
    parts_[number].likelihood = alone;
    if (end - begin < worth_splitting_ || depth >= kMostDepth || mostGain(group) <= cost(group)) return number;
    const Split split = bestSplit(group, begin, end);
    if (!split.exists) return number;
    if (split.likelihood - alone < kLittleGain * cost(group) && isEven(group, begin, end)) return number;
    const auto middle = std::partition(
        samples_.begin() + static_cast<std::ptrdiff_t>(begin), samples_.begin() + static_cast<std::ptrdiff_t>(end),
        [&split](const Corner& corner) { return coordinate(corner, split.axis) < split.at; });
    const auto cut = static_cast<std::size_t>(middle - samples_.begin());
    const std::size_t below = divide(begin, cut, split.below, depth + 1);
    const std::size_t above = divide(cut, end, split.above, depth + 1);
    const double divided = parts_[below].likelihood + parts_[above].likelihood - cost(group);
    if (divided <= alone) {
      parts_.resize(number + 1);
      return number;
    }
    parts_[number] = {split.at, static_cast<std::int32_t>(split.axis), below, above, divided};
    return number;
  }

  /// Returns the best split of a few. All of them are on the axis on which the group is longest, in mean box sides.
  Split bestSplit(const CornerGroup& group, std::size_t begin, std::size_t end) const {
    Split best;
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double length = extent(group, i) / side_[i];
      if (length > longest) {
        longest = length;
        best.axis = i;
      }
    }
    const std::size_t axis = best.axis;
    const double low = coordinate(group.low, axis), length = extent(group, axis);
    if (!(length > 0.0)) return best;
    std::array<CornerGroup, kBins> bins;
    const double scale = kBins / length;
    for (std::size_t i = begin; i < end; ++i) {  // 32 bits, because they are converted in fewer steps
      const auto bin = static_cast<std::int32_t>((static_cast<double>(coordinate(samples_[i], axis)) - low) * scale);
      bins[static_cast<std::uint32_t>(std::min(bin, kBins - 1))].add(samples_[i]);
    }
    std::array<CornerGroup, kBins> above;  // above[i]: the sum of the bins i .. kBins - 1
    above[kBins - 1] = bins[kBins - 1];
    for (std::size_t bin = kBins - 1; bin-- > 0;) {
      above[bin] = above[bin + 1];
      above[bin].add(bins[bin]);
    }
    CornerGroup below;
    // The first and the last bin are never empty: they hold the lowest and the highest corner.
    for (std::size_t bin = 1; bin < kBins; ++bin) {
      if (bins[bin - 1].count == 0.0) continue;  // the same two groups as for the split before
      below.add(bins[bin - 1]);
      const double likelihoods = roughLikelihood(below) + roughLikelihood(above[bin]);
      if (likelihoods <= best.likelihood) continue;
      best.likelihood = likelihoods;
      // Split midway between the two groups, so that few boxes cross the split when they move.
      const float end_below = coordinate(below.high, axis), begin_above = coordinate(above[bin].low, axis);
      const float midway = 0.5f * end_below + 0.5f * begin_above;
      best.at = midway > end_below ? midway : begin_above;
      best.exists = best.at > end_below;
      best.below = below;
      best.above = above[bin];
    }
    return best;
  }

  /// Returns whether the samples begin .. end - 1 are spread about evenly in their bounds. Divides the bounds into at
  /// most about as many cells as there are samples, and counts the samples in each cell. If the samples form groups,
  /// the cells with samples are more crowded.
  bool isEven(const CornerGroup& group, std::size_t begin, std::size_t end) {
    const double edge = std::cbrt(volumeOf(group) / group.count);
    std::array<double, 3> cells, scale;
    for (std::size_t i = 0; i < 3; ++i) {
      cells[i] = std::floor(std::clamp(extent(group, i) / edge, 1.0, group.count));
      scale[i] = extent(group, i) > 0.0 ? cells[i] / extent(group, i) : 0.0;
    }
    if (cells[0] * cells[1] * cells[2] > 8.0 * group.count) return false;
    counts_.assign(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]), 0);
    double crowding = 0.0;  // sum over all samples of the number of samples in the same cell
    for (std::size_t i = begin; i < end; ++i) {
      const auto cell = [&](std::size_t axis) {
        const double from_low = static_cast<double>(coordinate(samples_[i], axis)) - coordinate(group.low, axis);
        return static_cast<std::size_t>(std::min(from_low * scale[axis], cells[axis] - 1.0));
      };
      const std::size_t number =
          (cell(2) * static_cast<std::size_t>(cells[1]) + cell(1)) * static_cast<std::size_t>(cells[0]) + cell(0);
      crowding += 2.0 * counts_[number]++ + 1.0;
    }
    // If samples are placed at random, the cell of a sample has 1 + mean samples on average, this sample included.
    const double mean = group.count / static_cast<double>(counts_.size());
    return crowding <= kEvenCrowding * (1.0 + mean) * group.count;
  }

  /// Appends the branches and regions of a part to the tree. `space` is the space that the part covers.
  void lay(RegionTree& tree, std::size_t number, const kernels::Region& space) const {
    const Part& part = parts_[number];
    const auto branch = static_cast<std::uint32_t>(tree.branches_.size());
    tree.branches_.push_back({part.split, part.axis, 0, 0});
    if (part.axis < 0) {
      tree.branches_[branch].below = static_cast<std::uint32_t>(tree.regions_.size());
      tree.regions_.push_back(space);
      return;
    }
    kernels::Region half = space;
    half.high[part.axis] = part.split;
    tree.branches_[branch].below = static_cast<std::uint32_t>(tree.branches_.size());
    lay(tree, part.below, half);
    half = space;
    half.low[part.axis] = part.split;
    tree.branches_[branch].above = static_cast<std::uint32_t>(tree.branches_.size());
    lay(tree, part.above, half);
  }

  std::vector<Corner> samples_;
  std::size_t worth_splitting_;        // samples; smaller groups are not split
  std::array<double, 3> side_;         // [m] mean box side per axis
  std::vector<std::uint32_t> counts_;  // samples per cell, see isEven()
  std::vector<Part> parts_;            // each part is stored before the parts that it is split into
};

RegionTree::RegionTree() { join(); }

void RegionTree::join() {
  branches_.assign(1, {0.0f, -1, 0, 0});
  regions_.assign(1, {});
  std::fill_n(regions_[0].low, 3, -kFloatInfinity);
  std::fill_n(regions_[0].high, 3, kFloatInfinity);
}

RegionTree RegionTree::dividing(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count) {
  return Division(boxes, ids, count).tree();
}

std::uint32_t RegionTree::regionOf(const float* corner) const {
  const kernels::Branch* branch = branches_.data();
  while (branch->axis >= 0) {
    branch = branches_.data() + (corner[branch->axis] < branch->split ? branch->below : branch->above);
  }
  return branch->below;
}

void RegionTree::setLevels(std::size_t region, std::uint32_t first_level, std::uint32_t levels) {
  regions_[region].first_level = first_level;
  regions_[region].levels = levels;
}

std::size_t RegionTree::bytes() const {
  return branches_.capacity() * sizeof(kernels::Branch) + regions_.capacity() * sizeof(kernels::Region);
}

}  // namespace hgrid
