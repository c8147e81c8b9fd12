// SPDX-License-Identifier: Apache-2.0
// Transforms points from the tip to the base: 12 multiply-adds per joint. Included by the kernel files only.
#pragma once

#include "kinfer/kinematics/batch/constants_kernel.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

/// Several points at a time, so that the processor need not wait for the result of the previous one.
template <class V, int n>
struct Points {
  V x[n], y[n], z[n];
};

/// p in the frame before a link, whose numbers are at `m`.
template <class Constant, class V, int n>
inline void transform_link(const Number<V>* m, Points<V, n>& p) {
  const auto number = [m](int i) { return Constant::at(m, i); };
  Points<V, n> q;
  for (int u = 0; u < n; ++u) q.x[u] = mul_add(number(0), p.x[u], mul_add(number(1), p.y[u], number(3)));
  for (int u = 0; u < n; ++u) q.y[u] = mul_add(number(4), p.x[u], mul_add(number(5), p.y[u], number(6) * p.z[u]));
  for (int u = 0; u < n; ++u)
    q.z[u] = mul_add(number(8), p.x[u], mul_add(number(9), p.y[u], mul_add(number(10), p.z[u], number(11))));
  p = q;
}

/// measured − p in the frame before a link. The measured point starts the link's sums, which saves one operation.
template <class Constant, class V, int n>
inline void error_through_link(const Points<V, n>& measured, const Number<V>* m, Points<V, n>& p) {
  const auto minus = [m](int i) { return -Constant::at(m, i); };
  Points<V, n> q;
  for (int u = 0; u < n; ++u) q.x[u] = mul_add(minus(0), p.x[u], mul_add(minus(1), p.y[u], measured.x[u] + minus(3)));
  for (int u = 0; u < n; ++u)
    q.y[u] = mul_add(minus(4), p.x[u], mul_add(minus(5), p.y[u], mul_add(minus(6), p.z[u], measured.y[u])));
  for (int u = 0; u < n; ++u)
    q.z[u] =
        mul_add(minus(8), p.x[u], mul_add(minus(9), p.y[u], mul_add(minus(10), p.z[u], measured.z[u] + minus(11))));
  p = q;
}

/// p in the frame before any constant transform.
template <class Constant, class V, int n>
inline void transform_constant(Shape shape, const Number<V>* m, Points<V, n>& p) {
  const auto number = [m](int i) { return Constant::at(m, i); };
  if (shape == Shape::identity) return;
  if (shape == Shape::link) return transform_link<Constant>(m, p);
  Points<V, n> q = p;
  for (int u = 0; u < n; ++u) {
    const auto row = [&](int i) {
      return mul_add(number(i), p.x[u], mul_add(number(i + 1), p.y[u], mul_add(number(i + 2), p.z[u], number(i + 3))));
    };
    q.x[u] = row(0), q.y[u] = row(4), q.z[u] = row(8);
  }
  p = q;
}

/// p in the frame before a rotation about z.
template <class V, int n>
inline void transform_rotation(Points<V, n>& p, const V (&c)[n], const V (&s)[n]) {
  for (int u = 0; u < n; ++u) {
    const V x = mul_sub(c[u], p.x[u], s[u] * p.y[u]);
    p.y[u] = mul_add(s[u], p.x[u], c[u] * p.y[u]);
    p.x[u] = x;
  }
}

/// p in the frame before a joint motion. `datum(u, k)` is number k of the motion at item u; `extra_gain` is the
/// difference of the candidate's gain from the nominal one.
template <class V, int n, class Datum>
inline void transform_joint_motion(MotionKind move, V extra_gain, Datum datum, Points<V, n>& p) {
  V first[n], second[n];
  for (int u = 0; u < n; ++u) first[u] = datum(u, 0);
  if (move == MotionKind::prismatic) {
    for (int u = 0; u < n; ++u) p.z[u] += first[u];
    return;
  }
  if (move == MotionKind::prismatic_with_gain) {
    for (int u = 0; u < n; ++u) p.z[u] += mul_add(extra_gain, datum(u, 2), first[u]);
    return;
  }
  for (int u = 0; u < n; ++u) second[u] = datum(u, 1);
  transform_rotation(p, first, second);
  if (move == MotionKind::revolute) return;
  for (int u = 0; u < n; ++u) {
    const SinCos<V> more = sin_cos(extra_gain * datum(u, 2));
    first[u] = more.cos, second[u] = more.sin;
  }
  transform_rotation(p, first, second);
}

/// The points of a group after all transforms that are the same for all items, and the next joint motion inwards, that
/// after segment `movement`. A fixed point that rotates about a joint is on an arc, on_cos · cos + on_sin · sin +
/// centre: six multiply-adds for the rotation and the constant transform before it.
template <class V>
struct Start {
  Points<V, 1> centre, on_cos, on_sin;
  bool is_arc = false;
  int slot = 0;  ///< of the arc's cosine and sine in an item
  int joint_motion = 0;

  template <int n, class Datum>
  Points<V, n> at(Datum datum) const {
    Points<V, n> p;
    for (int u = 0; u < n; ++u) {
      p.x[u] = centre.x[0], p.y[u] = centre.y[0], p.z[u] = centre.z[0];
      if (!is_arc) continue;
      const V c = datum(u, slot), s = datum(u, slot + 1);
      p.x[u] = mul_add(on_cos.x[0], c, mul_add(on_sin.x[0], s, p.x[u]));
      p.y[u] = mul_add(on_cos.y[0], c, mul_add(on_sin.y[0], s, p.y[u]));
      p.z[u] = mul_add(on_cos.z[0], c, mul_add(on_sin.z[0], s, p.z[u]));
    }
    return p;
  }
};

/// The arc of a point that rotates about a joint, in the frame before the constant transform at `m`.
template <class Constant, class V>
inline void start_arc(const Number<V>* m, Start<V>& start) {
  const V x = start.centre.x[0], y = start.centre.y[0], z = start.centre.z[0];
  const auto row = [&](int i, V& on_cos, V& on_sin, V& centre) {
    const V first = Constant::at(m, i), second = Constant::at(m, i + 1);
    on_cos = mul_add(first, x, second * y);
    on_sin = mul_sub(second, x, first * y);
    centre = mul_add(Constant::at(m, i + 2), z, Constant::at(m, i + 3));
  };
  row(0, start.on_cos.x[0], start.on_sin.x[0], start.centre.x[0]);
  row(4, start.on_cos.y[0], start.on_sin.y[0], start.centre.y[0]);
  row(8, start.on_cos.z[0], start.on_sin.z[0], start.centre.z[0]);
  start.is_arc = true;
}

template <class Constant, class V>
inline Start<V> start_of(const Group& group, const Segment* segments, int segment_count, const Number<V>* numbers) {
  using T = Number<V>;
  const auto constant = [&](int k) { return numbers + Constant::place(k); };
  Start<V> start;
  Points<V, 1>& p = start.centre;
  p.x[0] = broadcast<V>(static_cast<T>(group.on_tool[0]));
  p.y[0] = broadcast<V>(static_cast<T>(group.on_tool[1]));
  p.z[0] = broadcast<V>(static_cast<T>(group.on_tool[2]));
  int last = segment_count - 1;
  transform_constant<Constant>(segments[last].shape, constant(last), p);
  if (group.on_last_axis) --last, transform_constant<Constant>(segments[last].shape, constant(last), p);
  if (last > 0 && segments[last - 1].move == MotionKind::revolute) {
    --last;
    start.slot = segments[last].slots_before;
    start_arc<Constant>(constant(last), start);
  }
  start.joint_motion = last - 1;
  return start;
}

/// True if all joints are revolute with links between them, as in most robots: their loop has no branches.
template <class V>
inline bool is_revolute_link_chain(const Segment* segments, const Start<V>& start) {
  bool yes = start.is_arc && start.joint_motion >= 0;
  for (int k = start.joint_motion; k >= 0; --k)
    yes &= segments[k].move == MotionKind::revolute && segments[k].shape == Shape::link;
  return yes;
}

/// measured − predicted of n items.
template <bool is_plain, class Constant, class V, int n, class Datum>
inline Points<V, n> errors_of(const Segment* segments, const Number<V>* numbers, const Start<V>& start, int stride,
                              Datum datum) {
  Points<V, n> measured;
  for (int u = 0; u < n; ++u)
    measured.x[u] = datum(u, stride - 3), measured.y[u] = datum(u, stride - 2), measured.z[u] = datum(u, stride - 1);
  Points<V, n> p = start.template at<n>(datum);
  for (int k = start.joint_motion; k >= 0; --k) {
    const Segment& segment = segments[k];
    const int before = segment.slots_before;
    const Number<V>* constant = numbers + Constant::place(k);
    if constexpr (is_plain) {
      V c[n], s[n];
      for (int u = 0; u < n; ++u) c[u] = datum(u, before), s[u] = datum(u, before + 1);
      transform_rotation(p, c, s);
      if (k > 0)
        transform_link<Constant>(constant, p);
      else
        error_through_link<Constant>(measured, constant, p);
    } else {
      transform_joint_motion(
          segment.move, Constant::at(constant, 12), [&](int u, int i) { return datum(u, before + i); }, p);
      transform_constant<Constant>(segment.shape, constant, p);
    }
  }
  if constexpr (!is_plain)
    for (int u = 0; u < n; ++u)
      p.x[u] = measured.x[u] - p.x[u], p.y[u] = measured.y[u] - p.y[u], p.z[u] = measured.z[u] - p.z[u];
  return p;
}

}  // namespace
}  // namespace kinfer::batch
