// SPDX-License-Identifier: Apache-2.0
// Residuals, their Jacobian and the normal equations of many points for one candidate: lanes are points. Included by
// the kernel files only.
//
// Inward pass: each point is transformed from the tool to the world, and its coordinates before each screw are stored.
// Outward pass: the rotation R of the frame is propagated from the world to the tool. A rotation about axis e of that
// frame moves the point by R (e × point), a translation by R e (the columns of the geometric Jacobian; Whitney 1972). R
// starts with the weights, so that the columns come out weighted. The normal equations are accumulated chunk by chunk:
// the Jacobian need not be stored.
#pragma once

#include "kinfer/kinematics/batch/points_kernel.hpp"
#include "kinfer/kinematics/batch/sines_kernel.hpp"
#include "kinfer/linalg/kernels/gram_kernel.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

/// Values of a screw for a candidate: cosine, sine, length, change of the gain.
inline constexpr int values_per_screw = 4;
/// Stored per point and screw: its two coordinates across the axis; cosine and sine where they differ between points.
inline constexpr int stored_per_screw = 4;

inline void fold_screws(const JacobianJob& job, const Sines& at, double* to) {
  for (int k = 0; k < job.screw_count; ++k, to += values_per_screw) {
    const Screw& screw = job.screws[k];
    to[0] = at.cos(screw.angle), to[1] = at.sin(screw.angle);
    to[2] = at.value(screw.length);
    to[3] = screw.gain.parameter < 0 ? 0.0 : at.value(screw.gain) - screw.gain.constant;
  }
}

template <int axis, class V, int n>
inline V (&part(Points<V, n>& p))[n] {
  if constexpr (axis == 0) return p.x;
  if constexpr (axis == 1) return p.y;
  if constexpr (axis == 2) return p.z;
}

/// Processes n blocks of points at a time.
template <class V, int n>
class PointSweep {
 public:
  static constexpr int lanes = Traits<V>::lanes;

  /// `stored`: stored_per_screw · n packs per screw. `to`: row 0 of column 0 of the first block; columns are `stride`
  /// numbers apart, blocks 3 packs.
  PointSweep(const JacobianJob& job, int block, const double* numbers, double* storage, double* to,
             std::ptrdiff_t stride)
      : job_(job), block_(block), numbers_(numbers), storage_(storage), to_(to), stride_(stride) {}

  /// Writes the weighted residuals and adds their squares to `sum`.
  void inward_pass(const double* on_tool, double* residuals, V& sum) const {
    Points<V, n> p;
    fill(p.x, on_tool[0]), fill(p.y, on_tool[1]), fill(p.z, on_tool[2]);
    for (int k = job_.screw_count - 1; k >= 0; --k) {
      const Screw& screw = job_.screws[k];
      const double* numbers = numbers_ + values_per_screw * k;
      if (screw.is_rotation) {
        apply_constant_rotation(screw.rotation, p);
      } else if (screw.move != MotionKind::none) {
        joint_inwards(screw, numbers, storage_at(k), p);
      } else if (screw.axis == 0) {
        screw_inwards<0>(numbers, storage_at(k), p);
      } else if (screw.axis == 1) {
        screw_inwards<1>(numbers, storage_at(k), p);
      } else {
        screw_inwards<2>(numbers, storage_at(k), p);
      }
    }
    const int measured = job_.stride - 3;
    for (int u = 0; u < n; ++u) {
      const V x = weight(u, 0) * (datum(u, measured) - p.x[u]), y = weight(u, 1) * (datum(u, measured + 1) - p.y[u]),
              z = weight(u, 2) * (datum(u, measured + 2) - p.z[u]);
      double* at = residuals + 3 * lanes * u;
      store(at, x), store(at + lanes, y), store(at + 2 * lanes, z);
      sum = mul_add(x, x, mul_add(y, y, mul_add(z, z, sum)));
    }
  }

  /// Writes the columns of the Jacobian.
  void outward_pass() const {
    Points<V, n> x, y, z;  // axes of the frame in world coordinates, weighted
    for (int u = 0; u < n; ++u) {
      const V zero = broadcast<V>(0.0);
      x.x[u] = -weight(u, 0), x.y[u] = zero, x.z[u] = zero;
      y.x[u] = zero, y.y[u] = -weight(u, 1), y.z[u] = zero;
      z.x[u] = zero, z.y[u] = zero, z.z[u] = -weight(u, 2);
    }
    for (int k = 0; k < job_.screw_count; ++k) {
      const Screw& screw = job_.screws[k];
      const double* numbers = numbers_ + values_per_screw * k;
      if (screw.is_rotation) {
        rotate(screw.rotation, x, y, z);
      } else if (screw.axis == 0) {
        screw_outwards(screw, numbers, storage_at(k), x, y, z);
      } else if (screw.axis == 1) {
        screw_outwards(screw, numbers, storage_at(k), y, z, x);
      } else if (screw.move == MotionKind::none) {
        screw_outwards(screw, numbers, storage_at(k), z, x, y);
      } else {
        joint_outwards(screw, numbers, storage_at(k), z, x, y);
      }
    }
  }

 private:
  static void fill(V (&to)[n], double value) {
    for (int u = 0; u < n; ++u) to[u] = broadcast<V>(value);
  }
  V datum(int u, int slot) const {
    return load<V>(job_.items + (static_cast<std::ptrdiff_t>(block_ + u) * job_.stride + slot) * lanes);
  }
  V weight(int u, int row) const {
    return load<V>(job_.weights + (static_cast<std::ptrdiff_t>(block_ + u) * 3 + row) * lanes);
  }
  double* storage_at(int k) const { return storage_ + static_cast<std::ptrdiff_t>(stored_per_screw * n * lanes) * k; }
  static double* stored_at(double* stored, int i, int u) { return stored + (i * n + u) * lanes; }

  static void apply_constant_rotation(const double* by, Points<V, n>& p) {
    Points<V, n> q = p;
    const auto row = [&](int i, int u) {
      return mul_add(broadcast<V>(by[i]), p.x[u],
                     mul_add(broadcast<V>(by[i + 1]), p.y[u], broadcast<V>(by[i + 2]) * p.z[u]));
    };
    for (int u = 0; u < n; ++u) q.x[u] = row(0, u), q.y[u] = row(3, u), q.z[u] = row(6, u);
    p = q;
  }

  /// p in the frame before a rotation; its coordinates across the axis are stored.
  template <int axis>
  static void rotate_inwards(const V (&c)[n], const V (&s)[n], double* stored, Points<V, n>& p) {
    V(&first)[n] = part<(axis + 1) % 3>(p), (&second)[n] = part<(axis + 2) % 3>(p);
    for (int u = 0; u < n; ++u) {
      const V a = first[u], b = second[u];
      first[u] = mul_sub(c[u], a, s[u] * b);
      second[u] = mul_add(s[u], a, c[u] * b);
      store(stored_at(stored, 0, u), first[u]), store(stored_at(stored, 1, u), second[u]);
    }
  }

  template <int axis>
  static void screw_inwards(const double* numbers, double* stored, Points<V, n>& p) {
    V c[n], s[n];
    fill(c, numbers[0]), fill(s, numbers[1]);
    rotate_inwards<axis>(c, s, stored, p);
    for (int u = 0; u < n; ++u) part<axis>(p)[u] += broadcast<V>(numbers[2]);
  }

  void joint_inwards(const Screw& screw, const double* numbers, double* stored, Points<V, n>& p) const {
    V c[n], s[n];
    fill(c, numbers[0]), fill(s, numbers[1]);
    for (int u = 0; u < n; ++u) {
      V first = datum(u, screw.slot);
      p.z[u] += broadcast<V>(numbers[2]);
      if (screw.move == MotionKind::prismatic_with_gain)
        first = mul_add(broadcast<V>(numbers[3]), datum(u, screw.slot + 2), first);
      if (screw.move == MotionKind::prismatic || screw.move == MotionKind::prismatic_with_gain) {
        p.z[u] += first;
        continue;
      }
      add_angle(c[u], s[u], first, datum(u, screw.slot + 1));
      if (screw.move != MotionKind::revolute_with_gain) continue;
      const SinCos<V> more = sin_cos(broadcast<V>(numbers[3]) * datum(u, screw.slot + 2));
      add_angle(c[u], s[u], more.cos, more.sin);
    }
    for (int u = 0; u < n; ++u) store(stored_at(stored, 2, u), c[u]), store(stored_at(stored, 3, u), s[u]);
    rotate_inwards<2>(c, s, stored, p);
  }

  /// The sum of two angles.
  static void add_angle(V& c, V& s, V by_c, V by_s) {
    const V was = c;
    c = mul_sub(was, by_c, s * by_s);
    s = mul_add(was, by_s, s * by_c);
  }

  void put(int parameter, int u, V x, V y, V z) const {
    double* at = to_ + parameter * stride_ + 3 * lanes * u;
    store(at, x), store(at + lanes, y), store(at + 2 * lanes, z);
  }

  /// first × second = axis.
  void write_columns(const Screw& screw, double* stored, const Points<V, n>& axis, const Points<V, n>& first,
                     const Points<V, n>& second) const {
    if (screw.angle.parameter >= 0)
      for (int u = 0; u < n; ++u) {
        const V a = load<V>(stored_at(stored, 0, u)), b = load<V>(stored_at(stored, 1, u));
        put(screw.angle.parameter, u, mul_sub(second.x[u], a, first.x[u] * b), mul_sub(second.y[u], a, first.y[u] * b),
            mul_sub(second.z[u], a, first.z[u] * b));
      }
    if (screw.length.parameter >= 0)
      for (int u = 0; u < n; ++u) put(screw.length.parameter, u, axis.x[u], axis.y[u], axis.z[u]);
  }

  static void rotate_outwards(const V (&c)[n], const V (&s)[n], Points<V, n>& first, Points<V, n>& second) {
    const auto turn = [&](V(&a)[n], V(&b)[n]) {
      for (int u = 0; u < n; ++u) {
        const V was = a[u];
        a[u] = mul_add(c[u], was, s[u] * b[u]);
        b[u] = mul_sub(c[u], b[u], s[u] * was);
      }
    };
    turn(first.x, second.x), turn(first.y, second.y), turn(first.z, second.z);
  }

  void screw_outwards(const Screw& screw, const double* numbers, double* stored, Points<V, n>& axis,
                      Points<V, n>& first, Points<V, n>& second) const {
    write_columns(screw, stored, axis, first, second);
    V c[n], s[n];
    fill(c, numbers[0]), fill(s, numbers[1]);
    rotate_outwards(c, s, first, second);
  }

  void joint_outwards(const Screw& screw, const double*, double* stored, Points<V, n>& axis, Points<V, n>& first,
                      Points<V, n>& second) const {
    write_columns(screw, stored, axis, first, second);
    if (screw.gain.parameter >= 0) write_gain(screw, stored, axis, first, second);
    V c[n], s[n];
    for (int u = 0; u < n; ++u) c[u] = load<V>(stored_at(stored, 2, u)), s[u] = load<V>(stored_at(stored, 3, u));
    rotate_outwards(c, s, first, second);
  }

  void write_gain(const Screw& screw, double* stored, const Points<V, n>& axis, const Points<V, n>& first,
                  const Points<V, n>& second) const {
    for (int u = 0; u < n; ++u) {
      const V position = datum(u, screw.slot + 2);
      if (screw.move == MotionKind::prismatic_with_gain) {
        put(screw.gain.parameter, u, position * axis.x[u], position * axis.y[u], position * axis.z[u]);
        continue;
      }
      const V a = position * load<V>(stored_at(stored, 0, u)), b = position * load<V>(stored_at(stored, 1, u));
      put(screw.gain.parameter, u, mul_sub(second.x[u], a, first.x[u] * b), mul_sub(second.y[u], a, first.y[u] * b),
          mul_sub(second.z[u], a, first.z[u] * b));
    }
  }

  static void rotate(const double* by, Points<V, n>& x, Points<V, n>& y, Points<V, n>& z) {
    const auto turn = [by](V(&a)[n], V(&b)[n], V(&c)[n]) {
      for (int u = 0; u < n; ++u) {
        const V was[3] = {a[u], b[u], c[u]};
        const auto column = [&](int i) {
          return mul_add(was[0], broadcast<V>(by[i]),
                         mul_add(was[1], broadcast<V>(by[3 + i]), was[2] * broadcast<V>(by[6 + i])));
        };
        a[u] = column(0), b[u] = column(1), c[u] = column(2);
      }
    };
    turn(x.x, y.x, z.x), turn(x.y, y.y, z.y), turn(x.z, y.z, z.z);
  }

  const JacobianJob& job_;
  int block_;
  const double* numbers_;
  double *storage_, *to_;
  std::ptrdiff_t stride_;
};

template <class V>
class JacobianKernel {
 public:
  static constexpr int lanes = Traits<V>::lanes, in_flight = blocks_in_flight;

  explicit JacobianKernel(const JacobianJob& job)
      : job_(job),
        numbers_(job.workspace),
        storage_(numbers_ + round_up(values_per_screw * job.screw_count, lanes)),
        chunk_(storage_ + stored_per_screw * in_flight * lanes * job.screw_count),
        gram_(job.columns, chunks_of(job.blocks), chunk_ + padded_columns(job.columns) * stride),
        sum_(broadcast<V>(0.0)) {
    fold_screws(job, Sines::of<V>(job.at, chunk_), numbers_);  // the chunk is not used yet
    for (int i = 0; i < job.idle_count; ++i) clear(job.idle[i]);
    if (!job.jacobian)
      for (int k = job.columns + 1; k < padded_columns(job.columns); ++k) clear(k);
  }

  /// Returns the sum of the squared residuals.
  double run() {
    for (int g = 0; g < job_.group_count; ++g) {
      const Group& group = job_.groups[g];
      int block = group.begin;
      for (; block + in_flight <= group.end; block += in_flight) sweep<in_flight>(block, group.on_tool);
      for (; block < group.end; ++block) sweep<1>(block, group.on_tool);
    }
    if (!job_.jacobian) gram_.finish(chunk_, stride, 3 * in_chunk_, job_.matrix, job_.gradient);
    double sum = 0.0;
    for (int lane = 0; lane < lanes; ++lane) sum += sum_[lane];
    return sum;
  }

 private:
  static constexpr int stride = 3 * blocks_per_chunk * lanes;

  /// Zeroes a column that no screw writes.
  void clear(int column) const {
    const std::ptrdiff_t numbers = job_.jacobian ? static_cast<std::ptrdiff_t>(job_.blocks) * 3 * lanes : stride;
    double* to = (job_.jacobian ? job_.jacobian : chunk_) + column * numbers;
    for (std::ptrdiff_t i = 0; i < numbers; ++i) to[i] = 0.0;
  }

  template <int n>
  void sweep(int block, const double* on_tool) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(block) * 3 * lanes;
    if (job_.jacobian) {
      const PointSweep<V, n> sweep(job_, block, numbers_, storage_, job_.jacobian + at,
                                   static_cast<std::ptrdiff_t>(job_.blocks) * 3 * lanes);
      sweep.inward_pass(on_tool, job_.residuals + at, sum_);
      sweep.outward_pass();
      return;
    }
    if (in_chunk_ + n > blocks_per_chunk) add_chunk();
    double* to = chunk_ + in_chunk_ * 3 * lanes;
    const PointSweep<V, n> sweep(job_, block, numbers_, storage_, to, stride);
    sweep.inward_pass(on_tool, to + job_.columns * stride, sum_);
    sweep.outward_pass();
    in_chunk_ += n;
  }

  void add_chunk() {
    gram_.add(chunk_, stride, 3 * in_chunk_);
    in_chunk_ = 0;
  }

  const JacobianJob& job_;
  double *numbers_, *storage_, *chunk_;
  Gram<V> gram_;
  V sum_;
  int in_chunk_ = 0;
};

template <class V>
double jacobian(const JacobianJob& job) {
  return JacobianKernel<V>(job).run();
}

}  // namespace
}  // namespace kinfer::batch
