// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/factories.h"
#include "bench/peers/sorted_arrays.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace hgrid {
namespace bench {

#if defined(__x86_64__)
namespace {

/// Array sort-and-sweep (after Ericson, Real-Time Collision Detection, 2005, section 7.5.2): sorted by min.x each
/// frame, each box tested against those that begin before it ends, eight at a time. The strongest simple rival.
class SweepPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>&) override {}
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    arrays_.take(frame.boxes);
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
      if (pairs.size() < count + frame.boxes.size()) pairs.resize(2 * pairs.size() + frame.boxes.size());
      count += sweep(i, pairs.data() + count);
    }
    pairs.resize(count);
  }

 private:
  /// Writes the pairs of box i with the later ones; at most one per box. Returns how many.
  __attribute__((target("avx2,bmi"))) std::size_t sweep(std::size_t i, ProxyPair* out) const {
    const float* min_x = arrays_.min_x.data();
    const float* min_y = arrays_.min_y.data();
    const float* max_y = arrays_.max_y.data();
    const float* min_z = arrays_.min_z.data();
    const float* max_z = arrays_.max_z.data();
    const float end = arrays_.max_x[i];
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
      const __m256 x = _mm256_cmp_ps(_mm256_loadu_ps(min_x + j), end_x, _CMP_LE_OQ);  // beyond the end: too far in x
      auto hits = static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(x, _mm256_and_ps(y, z))));
      for (; hits != 0; hits &= hits - 1) *out++ = ordered(mine, arrays_.id[j + _tzcnt_u32(hits)]);
    }
    return static_cast<std::size_t>(out - begin);
  }

  SortedArrays arrays_;
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
