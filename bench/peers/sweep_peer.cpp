// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>

#include "bench/peers/factories.h"
#include "bench/peers/sorted_arrays.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace hgrid {
namespace bench {

#if defined(__x86_64__)
namespace {

/// Array sort-and-sweep, a simple and strong peer (after Ericson, Real-Time Collision Detection, 2005, section 7.5.2).
///
/// Each frame sorts the boxes by their minimum along one axis. Then it tests each box with the later boxes that begin
/// before the box ends, eight at a time. load() selects the axis that needs the fewest tests.
class SweepPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override {
    std::uint64_t fewest = ~std::uint64_t{0};
    for (int axis = 0; axis < 3; ++axis) {
      arrays_.take(boxes, axis);
      const std::uint64_t tests = testCount();
      if (tests < fewest) fewest = tests, axis_ = axis;
    }
  }
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    arrays_.take(frame.boxes, axis_);
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
      if (pairs.size() < count + frame.boxes.size()) pairs.resize(2 * pairs.size() + frame.boxes.size());
      count += sweep(i, pairs.data() + count);
    }
    pairs.resize(count);
  }

 private:
  /// Returns the number of overlap tests in a frame if the boxes are in their current order.
  std::uint64_t testCount() const {
    const auto begin = arrays_.min[0].begin(), end = begin + static_cast<std::ptrdiff_t>(arrays_.id.size());
    std::uint64_t count = 0;
    for (auto low = begin; low != end; ++low) {
      const float high = arrays_.max[0][static_cast<std::size_t>(low - begin)];
      count += static_cast<std::uint64_t>(std::upper_bound(low, end, high) - low) - 1;
    }
    return count;
  }

  /// Writes the pairs of box i with later boxes. A later box is in at most one pair. Returns the number of pairs.
  __attribute__((target("avx2,bmi"))) std::size_t sweep(std::size_t i, ProxyPair* out) const {
    const float* min_x = arrays_.min[0].data();  // x stands for the sort axis
    const float* min_y = arrays_.min[1].data();
    const float* max_y = arrays_.max[1].data();
    const float* min_z = arrays_.min[2].data();
    const float* max_z = arrays_.max[2].data();
    const float end = arrays_.max[0][i];
    const __m256 end_x = _mm256_set1_ps(end);
    const __m256 low_y = _mm256_set1_ps(min_y[i]), high_y = _mm256_set1_ps(max_y[i]);
    const __m256 low_z = _mm256_set1_ps(min_z[i]), high_z = _mm256_set1_ps(max_z[i]);
    const ProxyId mine = arrays_.id[i];
    ProxyPair* const begin = out;
    for (std::size_t j = i + 1; min_x[j] <= end; j += 8) {
      const __m256 y = _mm256_and_ps(_mm256_cmp_ps(_mm256_loadu_ps(min_y + j), high_y, _CMP_LE_OQ),
                                     _mm256_cmp_ps(_mm256_loadu_ps(max_y + j), low_y, _CMP_GE_OQ));
      const __m256 z = _mm256_and_ps(_mm256_cmp_ps(_mm256_loadu_ps(min_z + j), high_z, _CMP_LE_OQ),
                                     _mm256_cmp_ps(_mm256_loadu_ps(max_z + j), low_z, _CMP_GE_OQ));
      const __m256 x = _mm256_cmp_ps(_mm256_loadu_ps(min_x + j), end_x, _CMP_LE_OQ);  // drops boxes that begin too late
      auto hits = static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(x, _mm256_and_ps(y, z))));
      for (; hits != 0; hits &= hits - 1) *out++ = ordered(mine, arrays_.id[j + _tzcnt_u32(hits)]);
    }
    return static_cast<std::size_t>(out - begin);
  }

  SortedArrays arrays_;
  int axis_ = 0;
};

}  // namespace

bool canSweep() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi"); }
std::unique_ptr<Peer> makeSweep() { return std::make_unique<SweepPeer>(); }

#else

bool canSweep() { return false; }
std::unique_ptr<Peer> makeSweep() { return nullptr; }

#endif

}  // namespace bench
}  // namespace hgrid
