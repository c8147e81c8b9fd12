// SPDX-License-Identifier: Apache-2.0
// Evaluates the constant transforms between the joints for candidate parameters. Included by the kernel files only.
#pragma once

#include "kinfer/base/pack_kernel.hpp"
#include "kinfer/kinematics/batch/kernel_interface.hpp"
#include "kinfer/kinematics/batch/sines_kernel.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

/// The 12 of its constant transform, then the change of the gain of the joint motion after it.
inline constexpr int values_per_segment = 13;

/// Memory layout of the segments' numbers where each lane has its own: number by number, lane by lane.
template <class V>
struct PerLane {
  static constexpr int number_stride = Traits<V>::lanes;
  static constexpr std::ptrdiff_t place(int segment) { return values_per_segment * number_stride * segment; }
  static V at(const Number<V>* m, int i) { return load<V>(m + i * number_stride); }
};
/// The layout where all lanes share them: number by number, in sheets of adjacent links. They are broadcast when they
/// are loaded, at no extra cost.
template <class V>
struct Shared {
  static constexpr int number_stride = links_per_sheet;
  static constexpr std::ptrdiff_t place(int segment) {
    const auto k = static_cast<unsigned>(segment);  // unsigned: a signed division by eight is more than a bit shift
    return k / number_stride * (values_per_segment * number_stride) + k % number_stride;
  }
  static V at(const Number<V>* m, int i) { return broadcast<V>(m[i * number_stride]); }
};

/// Sine and cosine of the nominal angle plus its change.
template <class V>
inline SinCos<V> changed_by(V sine, V cosine, V change) {
  const SinCos<V> by = sin_cos_near_zero(change);
  return {mul_add(sine, by.cos, cosine * by.sin), mul_sub(cosine, by.cos, sine * by.sin)};
}
template <class V>
inline typename Traits<V>::Mask is_near(V change) {
  const V small = broadcast<V>(Number<V>(0.125));
  return (typename Traits<V>::Mask)(change <= small) & (typename Traits<V>::Mask)(-change <= small);
}

/// Evaluates every constant transform, one candidate per lane.
template <class V>
class Folder {
 public:
  using T = Number<V>;
  using Mask = typename Traits<V>::Mask;
  static constexpr int lanes = Traits<V>::lanes;

  /// x: one pack per parameter; nominal: one number per parameter.
  Folder(const T* x, const double* nominal, const int* angles, int angle_count, T* numbers) : x_(x), numbers_(numbers) {
    Mask moderate = ~Mask{}, near = ~Mask{};
    for (int k = 0; k < angle_count; ++k) {
      const V angle = load<V>(x + angles[k] * lanes);
      moderate &= is_within_limit(angle);
      near &= is_near(angle - broadcast<V>(static_cast<T>(nominal[angles[k]])));
    }
    moderate_ = all_of<V>(moderate), near_ = all_of<V>(near);
  }

  /// For one candidate whose sines are known.
  Folder(const T* x, const Sines& known, T* numbers) : x_(x), known_(&known), numbers_(numbers) {}

  V value(const Value& v) const {
    return v.parameter < 0 ? broadcast<V>(static_cast<T>(v.constant)) : load<V>(x_ + v.parameter * lanes);
  }

  /// x[parameter] − constant; zero where there is no parameter.
  V change(const Value& v) const {
    return v.parameter < 0 ? broadcast<V>(T(0))
                           : load<V>(x_ + v.parameter * lanes) - broadcast<V>(static_cast<T>(v.constant));
  }

  void fold(const Segment* segments, int count) const {
    for (int k = 0; k < count; ++k) {
      const Segment& segment = segments[k];
      T* to = numbers_ + Place::place(k);
      if (!(is_one && segment.in_sheet)) fold(segment, to);
      if (segment.gain.parameter >= 0) store(to + 12 * number_stride, change(segment.gain));
    }
  }

 private:
  static constexpr bool is_one = lanes == 1;
  using Place = std::conditional_t<is_one, Shared<V>, PerLane<V>>;
  static constexpr int number_stride = Place::number_stride;

  void fold(const Segment& segment, T* to) const {
    if (!segment.varies) {
      for (int i = 0; i < 12; ++i) store(to + i * number_stride, broadcast<V>(static_cast<T>(segment.numbers[i])));
    } else if (segment.shape == Shape::link) {
      fold_link(segment, to);
    } else {
      fold_factors(segment, to);
    }
  }

  SinCos<V> angle(const Value& v) const {
    if (v.parameter < 0) return {broadcast<V>(static_cast<T>(v.sin)), broadcast<V>(static_cast<T>(v.cos))};
    if constexpr (lanes == 1)
      return {known_->sin(v), known_->cos(v)};
    else
      return changed_angle(v);
  }

  /// Near the nominal angle by the angle-sum identities.
  SinCos<V> changed_angle(const Value& v) const {
    if (near_) [[likely]]
      return changed_by(broadcast<V>(static_cast<T>(v.sin)), broadcast<V>(static_cast<T>(v.cos)), change(v));
    return moderate_ ? sin_cos_within_limit(value(v)) : sin_cos(value(v));
  }

  void fold_link(const Segment& segment, T* to) const {
    const SinCos<V> alpha = angle(segment.alpha), theta = angle(segment.theta);
    const V zero = broadcast<V>(T(0));
    // clang-format off
    const V m[12] = {theta.cos,             -theta.sin,             zero,       value(segment.a),
                     alpha.cos * theta.sin, alpha.cos * theta.cos, -alpha.sin, zero,
                     alpha.sin * theta.sin, alpha.sin * theta.cos,  alpha.cos, value(segment.d)};
    // clang-format on
    for (int i = 0; i < 12; ++i) store(to + i * number_stride, m[i]);
  }

  void fold_factors(const Segment& segment, T* to) const {
    V m[12];
    for (int i = 0; i < 12; ++i) m[i] = broadcast<V>(T(i % 5 == 0 ? 1 : 0));
    for (int f = 0; f < segment.factor_count; ++f) apply(segment.factors[f], m);
    for (int i = 0; i < 12; ++i) store(to + i * number_stride, m[i]);
  }

  void apply(const Factor& factor, V* m) const {
    if (factor.kind == Factor::Kind::axis_translation) {
      const V length = value(factor.value);
      for (int row = 0; row < 3; ++row) m[4 * row + 3] = mul_add(length, m[4 * row + factor.axis], m[4 * row + 3]);
    } else if (factor.kind == Factor::Kind::axis_rotation) {
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

  const T* x_;
  const Sines* known_ = nullptr;
  T* numbers_;
  bool moderate_ = false, near_ = false;
};

/// Values of a sheet's parameters for a candidate: x, or the nominal number where there is no parameter.
template <class V>
struct SheetValues {
  V value, change;

  SheetValues(const SheetColumn& column, int first, const double* x) {
    V now;
    for (int lane = 0; lane < Traits<V>::lanes; ++lane) now[lane] = x[column.parameter[first + lane]];
    const V nominal = load<V>(column.constant + first);
    value = select((typename Traits<V>::Mask)load<V>(column.is_free + first), now, nominal);
    change = value - nominal;
  }
};

/// Evaluates the links of a sheet, one per lane.
template <class V>
inline void fold_sheet(const LinkSheet& sheet, const double* x, double* to) {
  using Values = SheetValues<V>;
  for (int k = 0; k < links_per_sheet; k += Traits<V>::lanes) {
    const Values a(sheet.a, k, x), d(sheet.d, k, x), alpha(sheet.alpha, k, x), theta(sheet.theta, k, x);
    const bool near = all_of<V>(is_near(alpha.change) & is_near(theta.change));
    const auto rotated = [&](const SheetColumn& column, const Values& by) {
      if (near) [[likely]]
        return changed_by(load<V>(column.sin + k), load<V>(column.cos + k), by.change);
      return sin_cos(by.value);
    };
    const SinCos<V> sincos_alpha = rotated(sheet.alpha, alpha), sincos_theta = rotated(sheet.theta, theta);
    const V zero = broadcast<V>(0.0);
    // clang-format off
    const V m[12] = {sincos_theta.cos,               -sincos_theta.sin,               zero,        a.value,
                     sincos_alpha.cos * sincos_theta.sin, sincos_alpha.cos * sincos_theta.cos, -sincos_alpha.sin, zero,
                     sincos_alpha.sin * sincos_theta.sin, sincos_alpha.sin * sincos_theta.cos,  sincos_alpha.cos, d.value};
    // clang-format on
    for (int i = 0; i < 12; ++i) store(to + i * links_per_sheet + k, m[i]);
  }
}

}  // namespace
}  // namespace kinfer::batch
