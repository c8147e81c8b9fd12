// Sums of squared errors for whole populations (lanes are candidates), and errors of many points at one candidate
// (lanes are points). Included by the kernel files only.
#pragma once

#include "kinfer/kinematics/batch_points_kernel.hpp"

namespace kinfer::batch {
namespace {  // each kernel file has its own, compiled for its processor

/// Σ |measured − predicted|² of a block of candidates over items begin .. end, n of them in flight.
template <bool is_plain, class V, int n>
inline V sum_over(const PopulationJob<Number<V>>& job, const Number<V>* numbers, const Start<V>& start, int begin,
                  int end) {
  using T = Number<V>;
  V sum[n];
  for (int u = 0; u < n; ++u) sum[u] = broadcast<V>(T(0));
  for (int item = begin; item + n <= end; item += n) {
    const T* data = job.items + static_cast<std::ptrdiff_t>(item) * job.stride;
    const auto datum = [&](int u, int slot) { return broadcast<V>(data[u * job.stride + slot]); };
    Points<V, n> p;
    for (int u = 0; u < n; ++u) p.x[u] = start.point.x[0], p.y[u] = start.point.y[0], p.z[u] = start.point.z[0];
    carry_to_base<is_plain>(job.segments, numbers, start.movement, datum, p);
    for (int u = 0; u < n; ++u) {
      const V x = datum(u, job.stride - 3) - p.x[u], y = datum(u, job.stride - 2) - p.y[u],
              z = datum(u, job.stride - 1) - p.z[u];
      sum[u] = mul_add(x, x, mul_add(y, y, mul_add(z, z, sum[u])));
    }
  }
  for (int u = 1; u < n; ++u) sum[0] += sum[u];
  return sum[0];
}

/// The same for any number of items: those that are left over fly together, too.
template <bool is_plain, class V, int n>
inline V sum_over_all(const PopulationJob<Number<V>>& job, const Number<V>* numbers, const Start<V>& start, int begin,
                      int end) {
  const int rest = begin + (end - begin) / n * n;
  V sum = sum_over<is_plain, V, n>(job, numbers, start, begin, rest);
  if constexpr (n > 1) sum += sum_over_all<is_plain, V, n - 1>(job, numbers, start, rest, end);
  return sum;
}

/// One pack a parameter: candidates first .. first + lanes − 1; beyond the last one, the last one again.
template <class V>
inline void gather(const PopulationJob<Number<V>>& job, int first, Number<V>* x) {
  constexpr int lanes = Traits<V>::lanes;
  const double* column[lanes];
  for (int lane = 0; lane < lanes; ++lane) {
    const int candidate = first + lane < job.candidates ? first + lane : job.candidates - 1;
    column[lane] = job.x + candidate * job.x_stride;
  }
  for (int k = 0; k < job.unknowns; ++k) {
    V v;
    for (int lane = 0; lane < lanes; ++lane) v[lane] = static_cast<Number<V>>(column[lane][k]);
    store(x + k * lanes, v);
  }
}

template <class V, int in_flight>
void population_sums(const PopulationJob<Number<V>>& job) {
  using T = Number<V>;
  constexpr int lanes = Traits<V>::lanes;
  T *x = job.workspace, *numbers = x + lanes * job.unknowns;
  for (int first = 0; first < job.candidates; first += lanes) {
    gather<V>(job, first, x);
    Folder<V>(x, job.nominal, job.unknowns, numbers).fold(job.segments, job.segment_count);
    V sum = broadcast<V>(T(0));
    for (int g = 0; g < job.group_count; ++g) {
      const Group& group = job.groups[g];
      const Start<V> start = start_of<V>(group, job.segments, job.segment_count, numbers);
      sum += turns_and_links(job.segments, start.movement)
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
    Points<V, n> p;
    for (int u = 0; u < n; ++u) p.x[u] = start.point.x[0], p.y[u] = start.point.y[0], p.z[u] = start.point.z[0];
    carry_to_base<is_plain>(job.segments, numbers, start.movement, datum, p);
    for (int u = 0; u < n; ++u) {
      double* to = job.errors + static_cast<std::ptrdiff_t>(item + u) * 3 * lanes;
      store(to, datum(u, job.stride - 3) - p.x[u]);
      store(to + lanes, datum(u, job.stride - 2) - p.y[u]);
      store(to + 2 * lanes, datum(u, job.stride - 1) - p.z[u]);
    }
  }
}

template <bool is_plain, class V, int n>
inline void errors_over_all(const PointsJob& job, const double* numbers, const Start<V>& start, int begin, int end) {
  const int rest = begin + (end - begin) / n * n;
  errors_over<is_plain, V, n>(job, numbers, start, begin, rest);
  if constexpr (n > 1) errors_over_all<is_plain, V, n - 1>(job, numbers, start, rest, end);
}

/// One candidate, folded with its angles side by side, then spread over the lanes. Returns where its numbers are.
template <class V>
inline const double* folded(const PointsJob& job) {
  constexpr int lanes = Traits<V>::lanes;
  using One = Pack<double, 1>;
  const int padded = (job.unknowns + lanes - 1) / lanes * lanes, count = numbers_of_segment * job.segment_count;
  double *x = job.workspace, *cosines = x + padded, *sines = cosines + padded, *narrow = sines + padded;
  double* numbers = job.workspace + (3 * padded + count + lanes - 1) / lanes * lanes;
  for (int k = 0; k < padded; ++k) x[k] = k < job.unknowns ? job.x[k] : 0.0;
  for (int k = 0; k < padded; k += lanes) {
    const SinCos<V> angle = sin_cos(load<V>(x + k));
    store(cosines + k, angle.cos), store(sines + k, angle.sin);
  }
  Folder<One>(x, cosines, sines, narrow).fold(job.segments, job.segment_count);
  for (int i = 0; i < count; ++i) store(numbers + i * lanes, broadcast<V>(narrow[i]));
  return numbers;
}

template <class V, int in_flight>
void point_errors(const PointsJob& job) {
  const double* numbers = folded<V>(job);
  for (int g = 0; g < job.group_count; ++g) {
    const Group& group = job.groups[g];
    const Start<V> start = start_of<V>(group, job.segments, job.segment_count, numbers);
    if (turns_and_links(job.segments, start.movement))
      errors_over_all<true, V, in_flight>(job, numbers, start, group.begin, group.end);
    else
      errors_over_all<false, V, in_flight>(job, numbers, start, group.begin, group.end);
  }
}

}  // namespace
}  // namespace kinfer::batch
