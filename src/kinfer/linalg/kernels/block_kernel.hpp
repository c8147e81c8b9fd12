// SPDX-License-Identifier: Apache-2.0
// a bᵀ and b l⁻ᵀ in tiles that fill the registers (Goto, van de Geijn 2008). Blocks are small enough for the cache, so
// they are not packed beforehand. Included by the kernel files only.
#pragma once

#include "kinfer/base/pack_kernel.hpp"
#include "kinfer/linalg/kernels/block_jobs.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

inline constexpr int depth_per_pass =
    64;  // columns of a and b that stay in the cache while a tile's neighbours use them

/// Loads or stores the first `count` numbers of a pack only; the other lanes are zero.
template <class V>
inline V load_first(const double* from, int count) {
  constexpr int lanes = Traits<V>::lanes;
#if defined(__AVX512F__)
  if constexpr (lanes == 8) return V(_mm512_maskz_loadu_pd(static_cast<__mmask8>((1 << count) - 1), from));
#endif
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (lanes == 4)
    return V(_mm256_maskload_pd(from, _mm256_cmpgt_epi64(_mm256_set1_epi64x(count), _mm256_set_epi64x(3, 2, 1, 0))));
#endif
  V v{};
  for (int i = 0; i < lanes && i < count; ++i) v[i] = from[i];
  return v;
}
template <class V>
inline void store_first(double* to, V v, int count) {
  constexpr int lanes = Traits<V>::lanes;
#if defined(__AVX512F__)
  if constexpr (lanes == 8) return _mm512_mask_storeu_pd(to, static_cast<__mmask8>((1 << count) - 1), __m512d(v));
#endif
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (lanes == 4)
    return _mm256_maskstore_pd(to, _mm256_cmpgt_epi64(_mm256_set1_epi64x(count), _mm256_set_epi64x(3, 2, 1, 0)),
                               __m256d(v));
#endif
  for (int i = 0; i < lanes && i < count; ++i) to[i] = v[i];
}

/// Stacked packs, the last of which may hold only the first `last` numbers.
template <class V, int tall, bool whole>
struct Rows {
  static constexpr int lanes = Traits<V>::lanes;
  int last = lanes;

  V get(const double* from, int t) const {
    return whole || t + 1 < tall ? load<V>(from + t * lanes) : load_first<V>(from + t * lanes, last);
  }
  void put(double* to, int t, V v) const {
    if (whole || t + 1 < tall)
      store<V>(to + t * lanes, v);
    else
      store_first<V>(to + t * lanes, v, last);
  }
};

/// Calls visit(rows, first row) for rows begin .. end − 1, `most` packs at a time.
template <class V, int most, class Visit>
inline void each_rows(int begin, int end, const Visit& visit) {
  constexpr int lanes = Traits<V>::lanes;
  int i = begin;
  for (; i + most * lanes <= end; i += most * lanes) visit(Rows<V, most, true>{}, i);
  if constexpr (most > 1) {
    if (end - i > (most - 1) * lanes) return visit(Rows<V, most, false>{end - i - (most - 1) * lanes}, i);
    each_rows<V, most - 1>(i, end, visit);
  } else if (i < end) {
    visit(Rows<V, 1, false>{end - i}, i);
  }
}

template <class V, int tall, int wide, bool whole>
inline void add_tile(const ProductJob& job, const Rows<V, tall, whole>& rows, int i0, int j0, int first, int end) {
  V sum[tall][wide] = {};
  const double *a = job.a + i0 + first * job.a_stride, *b = job.b + j0 + first * job.b_stride;
  for (int k = first; k < end; ++k, a += job.a_stride, b += job.b_stride) {
    V left[tall];
    for (int t = 0; t < tall; ++t) left[t] = rows.get(a, t);
    for (int j = 0; j < wide; ++j) {
      const V right = broadcast<V>(b[j]);
      for (int t = 0; t < tall; ++t) sum[t][j] = mul_add(left[t], right, sum[t][j]);
    }
  }
  const V factor = broadcast<V>(job.factor);
  double* to = job.to + i0 + j0 * job.to_stride;
  for (int j = 0; j < wide; ++j, to += job.to_stride)
    for (int t = 0; t < tall; ++t) rows.put(to, t, mul_add(factor, sum[t][j], rows.get(to, t)));
}

/// All columns from j0 on, `wide` at a time, the remaining ones in halves of that.
template <class V, int wide>
inline void add_columns(const ProductJob& job, int j0, int first, int end) {
  for (; j0 + wide <= job.columns; j0 += wide)
    each_rows<V, 2>(job.lower ? j0 : 0, job.rows, [&]<int tall, bool whole>(const Rows<V, tall, whole>& rows, int i0) {
      add_tile<V, tall, wide, whole>(job, rows, i0, j0, first, end);
    });
  if constexpr (wide > 1) add_columns<V, wide / 2>(job, j0, first, end);
}

template <class V>
void add_product(const ProductJob& job) {
  constexpr int wide = Traits<V>::lanes == 8 ? 8 : 4;
  for (int k = 0; k < job.depth; k += depth_per_pass)
    add_columns<V, wide>(job, 0, k, k + depth_per_pass < job.depth ? k + depth_per_pass : job.depth);
}

/// Column by column of x, each from the previous ones.
template <class V>
void solve_right(const SolveJob& job) {
  each_rows<V, 4>(0, job.rows, [&]<int tall, bool whole>(const Rows<V, tall, whole>& rows, int i0) {
    double* b = job.b + i0;
    for (int j = 0; j < job.columns; ++j) {
      V sum[tall];
      for (int t = 0; t < tall; ++t) sum[t] = rows.get(b + j * job.b_stride, t);
      for (int m = 0; m < j; ++m) {
        const V l = broadcast<V>(-job.l[j + m * job.l_stride]);
        for (int t = 0; t < tall; ++t) sum[t] = mul_add(rows.get(b + m * job.b_stride, t), l, sum[t]);
      }
      const V by = broadcast<V>(1.0 / job.l[j + j * job.l_stride]);
      for (int t = 0; t < tall; ++t) rows.put(b + j * job.b_stride, t, sum[t] * by);
    }
  });
}

}  // namespace
}  // namespace kinfer::batch
