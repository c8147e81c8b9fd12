// The kernels that carry points from the tip inwards: 12 multiply-adds a joint. Included by the kernel files only.
#pragma once

#include "kinfer/kinematics/batch_kernel.hpp"
#include "kinfer/kinematics/batch_pack.hpp"

namespace kinfer::batch {
namespace {  // each kernel file has its own, compiled for its processor

/// Points in flight at the same time, so that the processor need not wait for the one before.
template <class V, int n>
struct Points {
  V x[n], y[n], z[n];
};

/// p seen from before a link, whose numbers are packs at `m`.
template <class V, int n>
inline void carry_link(const Number<V>* m, Points<V, n>& p) {
  constexpr int lanes = Traits<V>::lanes;
  const auto number = [m](int i) { return load<V>(m + i * lanes); };
  Points<V, n> q;
  for (int u = 0; u < n; ++u) q.x[u] = mul_add(number(0), p.x[u], mul_add(number(1), p.y[u], number(3)));
  for (int u = 0; u < n; ++u) q.y[u] = mul_add(number(4), p.x[u], mul_add(number(5), p.y[u], number(6) * p.z[u]));
  for (int u = 0; u < n; ++u)
    q.z[u] = mul_add(number(8), p.x[u], mul_add(number(9), p.y[u], mul_add(number(10), p.z[u], number(11))));
  p = q;
}

/// p seen from before any constant transform.
template <class V, int n>
inline void carry_constant(Shape shape, const Number<V>* m, Points<V, n>& p) {
  constexpr int lanes = Traits<V>::lanes;
  const auto number = [m](int i) { return load<V>(m + i * lanes); };
  if (shape == Shape::identity) return;
  if (shape == Shape::link) return carry_link(m, p);
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

/// p seen from before a movement. `datum(u, k)` is number k of the movement at item u; the pack at `extra_gain` is what
/// the candidate's gain differs by.
template <class V, int n, class Datum>
inline void carry_movement(Move move, const Number<V>* extra_gain, Datum datum, Points<V, n>& p) {
  V first[n], second[n];
  for (int u = 0; u < n; ++u) first[u] = datum(u, 0);
  if (move == Move::shift) {
    for (int u = 0; u < n; ++u) p.z[u] += first[u];
    return;
  }
  if (move == Move::shift_by_gain) {
    for (int u = 0; u < n; ++u) p.z[u] += mul_add(load<V>(extra_gain), datum(u, 2), first[u]);
    return;
  }
  for (int u = 0; u < n; ++u) second[u] = datum(u, 1);
  carry_turn(p, first, second);
  if (move == Move::turn) return;
  for (int u = 0; u < n; ++u) {
    const SinCos<V> more = sin_cos(load<V>(extra_gain) * datum(u, 2));
    first[u] = more.cos, second[u] = more.sin;
  }
  carry_turn(p, first, second);
}

/// The 12 of its constant, then the change of the gain of the movement after it.
inline constexpr int numbers_of_segment = 13;

/// Numbers of one candidate a lane: every constant transform, folded.
template <class V>
class Folder {
 public:
  using T = Number<V>;
  static constexpr int lanes = Traits<V>::lanes;

  /// x: one pack a parameter; nominal: one number a parameter.
  Folder(const T* x, const double* nominal, int unknowns, T* numbers) : x_(x), numbers_(numbers) {
    const V limit = broadcast<V>(Trigonometry<T>::limit), small = broadcast<V>(T(0.125));
    Mask moderate = ~Mask{}, near = ~Mask{};
    for (int k = 0; k < unknowns; ++k) {
      const V v = load<V>(x + k * lanes), change = v - broadcast<V>(static_cast<T>(nominal[k]));
      moderate &= (Mask)(v <= limit) & (Mask)(-v <= limit);
      near &= (Mask)(change <= small) & (Mask)(-change <= small);
    }
    moderate_ = all_set(moderate), near_ = all_set(near);
  }

  /// The same where cosine and sine of every parameter are known, one pack each.
  Folder(const T* x, const T* cosines, const T* sines, T* numbers)
      : x_(x), cosines_(cosines), sines_(sines), numbers_(numbers) {}

  V value(const Value& v) const {
    return v.parameter < 0 ? broadcast<V>(static_cast<T>(v.constant)) : load<V>(x_ + v.parameter * lanes);
  }

  /// x[parameter] − constant; zero where nothing changes.
  V change(const Value& v) const {
    return v.parameter < 0 ? broadcast<V>(T(0))
                           : load<V>(x_ + v.parameter * lanes) - broadcast<V>(static_cast<T>(v.constant));
  }

  void fold(const Segment* segments, int count) {
    for (int k = 0; k < count; ++k) {
      T* to = numbers_ + numbers_of_segment * lanes * k;
      fold(segments[k], to);
      store(to + 12 * lanes, change(segments[k].gain));
    }
  }

 private:
  void fold(const Segment& segment, T* to) {
    if (!segment.varies) {
      for (int i = 0; i < 12; ++i) store(to + i * lanes, broadcast<V>(static_cast<T>(segment.numbers[i])));
    } else if (segment.shape == Shape::link) {
      fold_link(segment, to);
    } else {
      fold_factors(segment, to);
    }
  }

  using Mask = typename Traits<V>::Mask;
  static bool all_set(Mask mask) {
    bool all = true;
    for (int i = 0; i < lanes; ++i) all &= mask[i] != 0;
    return all;
  }

  /// Near the nominal angle by the sum of angles.
  SinCos<V> angle(const Value& v) const {
    if (v.parameter < 0) return {broadcast<V>(static_cast<T>(v.sin)), broadcast<V>(static_cast<T>(v.cos))};
    if (sines_) return {load<V>(sines_ + v.parameter * lanes), load<V>(cosines_ + v.parameter * lanes)};
    if (near_) [[likely]] {
      const SinCos<V> by = sin_cos_near_zero(change(v));
      const V c = broadcast<V>(static_cast<T>(v.cos)), s = broadcast<V>(static_cast<T>(v.sin));
      return {mul_add(s, by.cos, c * by.sin), mul_sub(c, by.cos, s * by.sin)};
    }
    return moderate_ ? sin_cos_of_moderate(value(v)) : sin_cos(value(v));
  }

  void fold_link(const Segment& segment, T* to) {
    const SinCos<V> alpha = angle(segment.alpha), theta = angle(segment.theta);
    const V zero = broadcast<V>(T(0));
    // clang-format off
    const V m[12] = {theta.cos,             -theta.sin,             zero,       value(segment.a),
                     alpha.cos * theta.sin, alpha.cos * theta.cos, -alpha.sin, zero,
                     alpha.sin * theta.sin, alpha.sin * theta.cos,  alpha.cos, value(segment.d)};
    // clang-format on
    for (int i = 0; i < 12; ++i) store(to + i * lanes, m[i]);
  }

  void fold_factors(const Segment& segment, T* to) {
    V m[12];
    for (int i = 0; i < 12; ++i) m[i] = broadcast<V>(T(i % 5 == 0 ? 1 : 0));
    for (int f = 0; f < segment.factor_count; ++f) apply(segment.factors[f], m);
    for (int i = 0; i < 12; ++i) store(to + i * lanes, m[i]);
  }

  void apply(const Factor& factor, V* m) {
    if (factor.kind == Factor::Kind::shift) {
      const V length = value(factor.value);
      for (int row = 0; row < 3; ++row) m[4 * row + 3] = mul_add(length, m[4 * row + factor.axis], m[4 * row + 3]);
    } else if (factor.kind == Factor::Kind::turn) {
      const int i = factor.axis == 2 ? 0 : factor.axis + 1, j = 3 - factor.axis - i;
      const SinCos<V> by = angle(factor.value);
      for (int row = 0; row < 3; ++row) {
        const V u = m[4 * row + i], v = m[4 * row + j];
        m[4 * row + i] = mul_add(by.cos, u, by.sin * v);
        m[4 * row + j] = mul_sub(by.cos, v, by.sin * u);
      }
    } else {
      for (int row = 0; row < 3; ++row) {
        const V u[3] = {m[4 * row], m[4 * row + 1], m[4 * row + 2]};
        for (int col = 0; col < 3; ++col) {
          V sum = broadcast<V>(T(0));
          for (int k = 0; k < 3; ++k)
            sum = mul_add(u[k], broadcast<V>(static_cast<T>(factor.rotation[3 * k + col])), sum);
          m[4 * row + col] = sum;
        }
      }
    }
  }

  const T *x_, *cosines_ = nullptr, *sines_ = nullptr;
  T* numbers_;
  bool moderate_ = false, near_ = false;
};

/// Where the points of a group start, and before which movement they are then: what no item changes is done.
template <class V>
struct Start {
  Points<V, 1> point;
  int movement = 0;  ///< the next movement inwards is that after segment `movement`
};

template <class V>
inline Start<V> start_of(const Group& group, const Segment* segments, int segment_count, const Number<V>* numbers) {
  using T = Number<V>;
  constexpr int lanes = Traits<V>::lanes;
  Points<V, 1> p;
  p.x[0] = broadcast<V>(static_cast<T>(group.on_tool[0]));
  p.y[0] = broadcast<V>(static_cast<T>(group.on_tool[1]));
  p.z[0] = broadcast<V>(static_cast<T>(group.on_tool[2]));
  int last = segment_count - 1;
  carry_constant(segments[last].shape, numbers + numbers_of_segment * lanes * last, p);
  if (group.on_last_axis) {
    --last;
    carry_constant(segments[last].shape, numbers + numbers_of_segment * lanes * last, p);
  }
  return {p, last - 1};
}

/// True where joints turn and links lie between them: most robots. Their loop has nothing to decide.
inline bool turns_and_links(const Segment* segments, int movement) {
  bool yes = true;
  for (int k = movement; k >= 0; --k) yes &= segments[k].move == Move::turn && segments[k].shape == Shape::link;
  return yes;
}

/// All the way from the start to the base.
template <bool is_plain, class V, int n, class Datum>
inline void carry_to_base(const Segment* segments, const Number<V>* numbers, int movement, Datum datum,
                          Points<V, n>& p) {
  constexpr int lanes = Traits<V>::lanes;
  for (int k = movement; k >= 0; --k) {
    const Segment& segment = segments[k];
    const int before = segment.slots_before;
    const Number<V>* constant = numbers + numbers_of_segment * lanes * k;
    if constexpr (is_plain) {
      V c[n], s[n];
      for (int u = 0; u < n; ++u) c[u] = datum(u, before), s[u] = datum(u, before + 1);
      carry_turn(p, c, s);
      carry_link(constant, p);
    } else {
      carry_movement(
          segment.move, constant + 12 * lanes, [&](int u, int i) { return datum(u, before + i); }, p);
      carry_constant(segment.shape, constant, p);
    }
  }
}

}  // namespace
}  // namespace kinfer::batch
