// SPDX-License-Identifier: Apache-2.0
// Sums of squared errors of whole populations (lanes are candidates), and errors of many points for one candidate
// (lanes are points). Included by the kernel files only.
#pragma once

#include "kinfer/kinematics/batch/points_kernel.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

/// Σ |measured − predicted|² of a block of candidates over items begin .. end, n of them at a time.
template <bool is_plain, class V, int n>
inline V sum_over(const PopulationJob<Number<V>>& job, const Number<V>* numbers, const Start<V>& start, int begin,
                  int end) {
  using T = Number<V>;
  V sum[n];
  for (int u = 0; u < n; ++u) sum[u] = broadcast<V>(T(0));
  for (int item = begin; item + n <= end; item += n) {
    const T* data = job.items + static_cast<std::ptrdiff_t>(item) * job.stride;
    const auto datum = [&](int u, int slot) { return broadcast<V>(data[u * job.stride + slot]); };
    const auto e = errors_of<is_plain, PerLane<V>, V, n>(job.segments, numbers, start, job.stride, datum);
    for (int u = 0; u < n; ++u)
      sum[u] = mul_add(e.x[u], e.x[u], mul_add(e.y[u], e.y[u], mul_add(e.z[u], e.z[u], sum[u])));
  }
  for (int u = 1; u < n; ++u) sum[0] += sum[u];
  return sum[0];
}

/// How many batches of n items come first, so that batches of n − 1 do the rest: smaller batches are avoided where
/// possible.
inline int full_batches(int items, int n) {
  const int full = items / n, rest = items % n;
  if (rest == 0 || n == 1) return full;
  const int dropped = n - 1 - rest;  // each batch that is given up leaves one item more
  return full >= dropped ? full - dropped : full;
}

/// The same for any number of items.
template <bool is_plain, class V, int n>
inline V sum_over_all(const PopulationJob<Number<V>>& job, const Number<V>* numbers, const Start<V>& start, int begin,
                      int end) {
  const int rest = begin + full_batches(end - begin, n) * n;
  V sum = sum_over<is_plain, V, n>(job, numbers, start, begin, rest);
  if constexpr (n > 1) sum += sum_over_all<is_plain, V, n - 1>(job, numbers, start, rest, end);
  return sum;
}

/// Transposes numbers k .. k + 3 of four candidates, so that the same number of all four is contiguous.
template <class T>
inline void transpose_four(const double* const* column, int k, T* to, int stride) {
  using Four = Pack<double, 4>;
  typedef T Narrow __attribute__((vector_size(4 * sizeof(T))));
  typedef T Unaligned __attribute__((vector_size(4 * sizeof(T)), aligned(alignof(T)), may_alias));
  const Four a = load<Four>(column[0] + k), b = load<Four>(column[1] + k), c = load<Four>(column[2] + k),
             d = load<Four>(column[3] + k);
  const Four ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7),
             cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  const auto put = [&](int number, Four v) {
    *reinterpret_cast<Unaligned*>(to + number * stride) = __builtin_convertvector(v, Narrow);
  };
  put(0, __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5));
  put(1, __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5));
  put(2, __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7));
  put(3, __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7));
}

/// One pack per parameter: candidates first .. first + lanes − 1; beyond the last one, the last one again.
template <class V>
inline void gather(const PopulationJob<Number<V>>& job, int first, Number<V>* x) {
  constexpr int lanes = Traits<V>::lanes;
  const double* column[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const int candidate = first + lane < job.candidates ? first + lane : job.candidates - 1;
    column[lane] = job.x + candidate * job.x_stride;
  }
  int k = 0;
  if constexpr (sizeof(V) >= sizeof(Pack<double, 4>))
    for (; k + 4 <= job.unknowns; k += 4)
      for (int lane = 0; lane < lanes; lane += 4) transpose_four(column + lane, k, x + k * lanes + lane, lanes);
  for (; k < job.unknowns; ++k)
    for (int lane = 0; lane < lanes; ++lane) x[k * lanes + lane] = static_cast<Number<V>>(column[lane][k]);
}

template <class V, int in_flight>
void population_sums(const PopulationJob<Number<V>>& job) {
  using T = Number<V>;
  constexpr int lanes = Traits<V>::lanes;
  T *x = job.workspace, *numbers = x + lanes * job.unknowns;
  for (int first = 0; first < job.candidates; first += lanes) {
    gather<V>(job, first, x);
    Folder<V>(x, job.nominal, job.angles, job.angle_count, numbers).fold(job.segments, job.segment_count);
    V sum = broadcast<V>(T(0));
    for (int g = 0; g < job.group_count; ++g) {
      const Group& group = job.groups[g];
      const Start<V> start = start_of<PerLane<V>, V>(group, job.segments, job.segment_count, numbers);
      sum += is_revolute_link_chain(job.segments, start)
                 ? sum_over_all<true, V, in_flight>(job, numbers, start, group.begin, group.end)
                 : sum_over_all<false, V, in_flight>(job, numbers, start, group.begin, group.end);
    }
    for (int lane = 0; lane < lanes && first + lane < job.candidates; ++lane)
      job.sums[first + lane] = static_cast<double>(sum[lane]);
  }
}

template <bool is_plain, class V, int n>
inline void errors_over(const PointsJob& job, const double* numbers, const Start<V>& start, int begin, int end) {
  constexpr int lanes = Traits<V>::lanes;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(job.stride) * lanes;
  for (int item = begin; item + n <= end; item += n) {
    const double* data = job.items + item * stride;
    const auto datum = [&](int u, int slot) { return load<V>(data + u * stride + slot * lanes); };
    const auto e = errors_of<is_plain, Shared<V>, V, n>(job.segments, numbers, start, job.stride, datum);
    for (int u = 0; u < n; ++u) {
      double* to = job.errors + static_cast<std::ptrdiff_t>(item + u) * 3 * lanes;
      store(to, e.x[u]), store(to + lanes, e.y[u]), store(to + 2 * lanes, e.z[u]);
    }
  }
}

template <bool is_plain, class V, int n>
inline void errors_over_all(const PointsJob& job, const double* numbers, const Start<V>& start, int begin, int end) {
  const int rest = begin + full_batches(end - begin, n) * n;
  errors_over<is_plain, V, n>(job, numbers, start, begin, rest);
  if constexpr (n > 1) errors_over_all<is_plain, V, n - 1>(job, numbers, start, rest, end);
}

template <class V, int in_flight>
void point_errors(const PointsJob& job) {
  constexpr int lanes = Traits<V>::lanes;
  double* numbers = job.workspace + sines_workspace(job.at.angle_count, lanes);
  for (int k = 0; job.sheets && k < job.segment_count; k += links_per_sheet)
    fold_sheet<V>(job.sheets[k / links_per_sheet], job.at.x, numbers + Shared<V>::place(k));
  const Sines known = Sines::of<V>(job.at, job.workspace);
  Folder<double>(job.at.x, known, numbers).fold(job.segments, job.segment_count);
  for (int g = 0; g < job.group_count; ++g) {
    const Group& group = job.groups[g];
    const Start<V> start = start_of<Shared<V>, V>(group, job.segments, job.segment_count, numbers);
    if (is_revolute_link_chain(job.segments, start))
      errors_over_all<true, V, in_flight>(job, numbers, start, group.begin, group.end);
    else
      errors_over_all<false, V, in_flight>(job, numbers, start, group.begin, group.end);
  }
}

}  // namespace
}  // namespace kinfer::batch
