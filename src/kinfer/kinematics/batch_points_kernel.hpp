// The kernels that carry points from the tip inwards: 12 multiply-adds a joint. Included by the kernel files only.
#pragma once

#include "kinfer/kinematics/batch_fold_kernel.hpp"

namespace kinfer::batch {
namespace {  // each kernel file has its own, compiled for its processor

/// Points in flight at the same time, so that the processor need not wait for the one before.
template <class V, int n>
struct Points {
  V x[n], y[n], z[n];
};

/// p seen from before a link, whose numbers are at `m`.
template <class Constant, class V, int n>
inline void carry_link(const Number<V>* m, Points<V, n>& p) {
  const auto number = [m](int i) { return Constant::at(m, i); };
  Points<V, n> q;
  for (int u = 0; u < n; ++u) q.x[u] = mul_add(number(0), p.x[u], mul_add(number(1), p.y[u], number(3)));
  for (int u = 0; u < n; ++u) q.y[u] = mul_add(number(4), p.x[u], mul_add(number(5), p.y[u], number(6) * p.z[u]));
  for (int u = 0; u < n; ++u)
    q.z[u] = mul_add(number(8), p.x[u], mul_add(number(9), p.y[u], mul_add(number(10), p.z[u], number(11))));
  p = q;
}

/// measured − p seen from before a link. The difference begins where the link's sums begin, which saves one step.
template <class Constant, class V, int n>
inline void carry_link_to(const Points<V, n>& measured, const Number<V>* m, Points<V, n>& p) {
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

/// p seen from before any constant transform.
template <class Constant, class V, int n>
inline void carry_constant(Shape shape, const Number<V>* m, Points<V, n>& p) {
  const auto number = [m](int i) { return Constant::at(m, i); };
  if (shape == Shape::identity) return;
  if (shape == Shape::link) return carry_link<Constant>(m, p);
  Points<V, n> q = p;
  for (int u = 0; u < n; ++u) {
    const auto row = [&](int i) {
      return mul_add(number(i), p.x[u], mul_add(number(i + 1), p.y[u], mul_add(number(i + 2), p.z[u], number(i + 3))));
    };
    q.x[u] = row(0), q.y[u] = row(4), q.z[u] = row(8);
  }
  p = q;
}

/// p seen from before a turn about z.
template <class V, int n>
inline void carry_turn(Points<V, n>& p, const V (&c)[n], const V (&s)[n]) {
  for (int u = 0; u < n; ++u) {
    const V x = mul_sub(c[u], p.x[u], s[u] * p.y[u]);
    p.y[u] = mul_add(s[u], p.x[u], c[u] * p.y[u]);
    p.x[u] = x;
  }
}

/// p seen from before a movement. `datum(u, k)` is number k of the movement at item u; `extra_gain` is what the
/// candidate's gain differs by.
template <class V, int n, class Datum>
inline void carry_movement(Move move, V extra_gain, Datum datum, Points<V, n>& p) {
  V first[n], second[n];
  for (int u = 0; u < n; ++u) first[u] = datum(u, 0);
  if (move == Move::shift) {
    for (int u = 0; u < n; ++u) p.z[u] += first[u];
    return;
  }
  if (move == Move::shift_by_gain) {
    for (int u = 0; u < n; ++u) p.z[u] += mul_add(extra_gain, datum(u, 2), first[u]);
    return;
  }
  for (int u = 0; u < n; ++u) second[u] = datum(u, 1);
  carry_turn(p, first, second);
  if (move == Move::turn) return;
  for (int u = 0; u < n; ++u) {
    const SinCos<V> more = sin_cos(extra_gain * datum(u, 2));
    first[u] = more.cos, second[u] = more.sin;
  }
  carry_turn(p, first, second);
}

/// Where the points of a group are once all that no item changes is done, and the next movement inwards, that after
/// segment `movement`. Behind a turn a fixed point is on an arc: on_cos · cos + on_sin · sin + centre, six
/// multiply-adds for the turn and the constant before it.
template <class V>
struct Start {
  Points<V, 1> centre, on_cos, on_sin;
  bool is_arc = false;
  int slot = 0;  ///< of the arc's cosine and sine in an item
  int movement = 0;

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

/// The arc of a point that turns before the constant transform at `m`.
template <class Constant, class V>
inline void bend(const Number<V>* m, Start<V>& start) {
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
  carry_constant<Constant>(segments[last].shape, constant(last), p);
  if (group.on_last_axis) --last, carry_constant<Constant>(segments[last].shape, constant(last), p);
  if (last > 0 && segments[last - 1].move == Move::turn) {
    --last;
    start.slot = segments[last].slots_before;
    bend<Constant>(constant(last), start);
  }
  start.movement = last - 1;
  return start;
}

/// True where joints turn and links lie between them: most robots. Their loop has nothing to decide.
template <class V>
inline bool turns_and_links(const Segment* segments, const Start<V>& start) {
  bool yes = start.is_arc && start.movement >= 0;
  for (int k = start.movement; k >= 0; --k) yes &= segments[k].move == Move::turn && segments[k].shape == Shape::link;
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
  for (int k = start.movement; k >= 0; --k) {
    const Segment& segment = segments[k];
    const int before = segment.slots_before;
    const Number<V>* constant = numbers + Constant::place(k);
    if constexpr (is_plain) {
      V c[n], s[n];
      for (int u = 0; u < n; ++u) c[u] = datum(u, before), s[u] = datum(u, before + 1);
      carry_turn(p, c, s);
      if (k > 0)
        carry_link<Constant>(constant, p);
      else
        carry_link_to<Constant>(measured, constant, p);
    } else {
      carry_movement(
          segment.move, Constant::at(constant, 12), [&](int u, int i) { return datum(u, before + i); }, p);
      carry_constant<Constant>(segment.shape, constant, p);
    }
  }
  if constexpr (!is_plain)
    for (int u = 0; u < n; ++u)
      p.x[u] = measured.x[u] - p.x[u], p.y[u] = measured.y[u] - p.y[u], p.z[u] = measured.z[u] - p.z[u];
  return p;
}

}  // namespace
}  // namespace kinfer::batch
