// SPDX-License-Identifier: Apache-2.0
// SIMD packs (several numbers in one register) and the arithmetic that the batch kernels are written in.
//
// Included by the kernel files only, each of which is compiled for one instruction set. Everything has internal
// linkage, so that no other file can link a function compiled for an instruction set the processor may lack.
#pragma once

#include <cstdint>
#include <type_traits>
#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

template <class T, int lanes>
struct PackOf {
  typedef T type __attribute__((vector_size(lanes * sizeof(T))));
  typedef T unaligned __attribute__((vector_size(lanes * sizeof(T)), aligned(alignof(T)), may_alias));
  using Bits = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;
  typedef Bits mask __attribute__((vector_size(lanes * sizeof(T))));
};
template <class T, int lanes>
using Pack = typename PackOf<T, lanes>::type;

/// Scalar type, number of lanes and mask type of a pack.
template <class V>
struct Traits {
  using Number = std::remove_cvref_t<decltype(V{}[0])>;
  static constexpr int lanes = sizeof(V) / sizeof(Number);
  using Bits = typename PackOf<Number, lanes>::Bits;
  using Mask = typename PackOf<Number, lanes>::mask;
};
/// A scalar is a pack with one lane.
template <>
struct Traits<double> {
  using Number = double;
  static constexpr int lanes = 1;
  using Bits = std::int64_t;
  using Mask = std::int64_t;
};
template <class V>
using Number = typename Traits<V>::Number;

template <class V>
inline V broadcast(Number<V> value) {
  return value - V{};
}

/// Unaligned access: only the alignment of the scalar is required.
template <class V>
inline V load(const Number<V>* from) {
  if constexpr (std::is_same_v<V, Number<V>>)
    return *from;
  else
    return *reinterpret_cast<const typename PackOf<Number<V>, Traits<V>::lanes>::unaligned*>(from);
}
template <class V>
inline void store(Number<V>* to, V v) {
  if constexpr (std::is_same_v<V, Number<V>>)
    *to = v;
  else
    *reinterpret_cast<typename PackOf<Number<V>, Traits<V>::lanes>::unaligned*>(to) = v;
}

/// a b + c and a b − c, with a single rounding where the processor has fused multiply-add.
template <class V>
inline V mul_add(V a, V b, V c) {
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<V, Pack<double, 8>>) return V(_mm512_fmadd_pd(__m512d(a), __m512d(b), __m512d(c)));
  if constexpr (std::is_same_v<V, Pack<float, 16>>) return V(_mm512_fmadd_ps(__m512(a), __m512(b), __m512(c)));
#endif
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (std::is_same_v<V, Pack<double, 4>>) return V(_mm256_fmadd_pd(__m256d(a), __m256d(b), __m256d(c)));
  if constexpr (std::is_same_v<V, Pack<float, 8>>) return V(_mm256_fmadd_ps(__m256(a), __m256(b), __m256(c)));
#endif
  return a * b + c;
}
template <class V>
inline V mul_sub(V a, V b, V c) {
  return mul_add(a, b, -c);
}

template <class V>
inline typename Traits<V>::Mask bits_of(V v) {
  return (typename Traits<V>::Mask)v;
}
template <class V>
inline V from_bits(typename Traits<V>::Mask bits) {
  return (V)bits;
}
/// a where the mask is set, b elsewhere.
template <class V>
inline V select(typename Traits<V>::Mask mask, V a, V b) {
  return from_bits<V>((bits_of(a) & mask) | (bits_of(b) & ~mask));
}

/// True if the comparison holds in all lanes.
template <class V>
inline bool all_of(typename Traits<V>::Mask mask) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64) return _mm512_cmpneq_epi32_mask(__m512i(mask), _mm512_set1_epi32(-1)) == 0;
#endif
#if defined(__AVX2__) && defined(__FMA__)
  if constexpr (sizeof(V) == 32) return _mm256_movemask_epi8(__m256i(mask)) == -1;
#endif
  bool all = true;
  for (int i = 0; i < Traits<V>::lanes; ++i) all &= mask[i] != 0;
  return all;
}

template <class V>
struct SinCos {
  V sin, cos;
};

/// Constants for each precision. π/2 is split into parts (Cody-Waite range reduction) whose products with a whole
/// number of quarter turns are exact as long as the angle is below `limit`. `terms` terms of the series give full
/// precision up to π/4, `terms_near_zero` up to 1/8.
template <class T>
struct Trigonometry;
template <>
struct Trigonometry<double> {
  static constexpr double to_integer = 0x1.8p52, limit = 1e5;
  static constexpr double half_pi_parts[] = {0x1.921fb544p0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};
  static constexpr int terms = 8, terms_near_zero = 5;
};
template <>
struct Trigonometry<float> {
  static constexpr float to_integer = 0x1.8p23f, limit = 1e3f;
  static constexpr float half_pi_parts[] = {0x1.92p0f, 0x1.fb4p-12f, 0x1.4442d2p-24f};
  static constexpr int terms = 5, terms_near_zero = 3;
};

/// Coefficients (−1)^k / (2k + odd)! of the series of sine (odd = 1, divided by the angle) and cosine (odd = 0).
template <class T, int odd>
struct Coefficients {
  T of[Trigonometry<T>::terms + 1];
  constexpr Coefficients() : of() {
    double c = 1.0;
    for (int k = 0; k <= Trigonometry<T>::terms; ++k) {
      of[k] = static_cast<T>(c);
      c /= -(2.0 * k + odd + 1.0) * (2.0 * k + odd + 2.0);
    }
  }
};

/// The terms z^first .. z^last, divided by z^first, by Horner's scheme.
template <class V, int odd, int first, int last>
inline V series(V z) {
  static constexpr Coefficients<Number<V>, odd> coefficient;
  V sum = broadcast<V>(coefficient.of[last]);
  for (int k = last - 1; k >= first; --k) sum = mul_add(sum, z, broadcast<V>(coefficient.of[k]));
  return sum;
}

/// Sine and cosine of angles within ±1/8.
template <class V>
inline SinCos<V> sin_cos_near_zero(V x) {
  constexpr int last = Trigonometry<Number<V>>::terms_near_zero;
  using T = Number<V>;
  const V z = x * x;
  const V s = mul_add(x * z, series<V, 1, 1, last - 1>(z), x);
  const V c = mul_add(z * z, series<V, 0, 2, last>(z), mul_add(z, broadcast<V>(T(-0.5)), broadcast<V>(T(1))));
  return {s, c};
}

template <class V>
inline typename Traits<V>::Mask is_within_limit(V angle) {
  const V limit = broadcast<V>(Trigonometry<Number<V>>::limit);
  return (typename Traits<V>::Mask)(angle <= limit) & (typename Traits<V>::Mask)(-angle <= limit);
}

/// Sine and cosine of angles within ± limit, to an ulp or two.
template <class V>
inline SinCos<V> sin_cos_within_limit(V x) {
  using T = Number<V>;
  using Trig = Trigonometry<T>;
  using Mask = typename Traits<V>::Mask;
  constexpr T quarters_per_radian = T(0.63661977236758134308);
  const V magic = broadcast<V>(Trig::to_integer);
  const V shifted = mul_add(x, broadcast<V>(quarters_per_radian), magic);
  const V n = shifted - magic;
  V r = x;
  for (const T part : Trig::half_pi_parts) r = mul_add(-n, broadcast<V>(part), r);
  const V z = r * r;
  const V s = mul_add(r * z, series<V, 1, 1, Trig::terms>(z), r);
  const V c = mul_add(z * z, series<V, 0, 2, Trig::terms>(z), mul_add(z, broadcast<V>(T(-0.5)), broadcast<V>(T(1))));
  // The last two bits of `shifted` are the quadrant.
  constexpr int sign_bit = 8 * sizeof(T) - 1;
  const Mask quadrant = bits_of(shifted);
  const Mask odd = -(quadrant & 1);
  const Mask sine_sign = (quadrant >> 1 & 1) << sign_bit, cosine_sign = ((quadrant + 1) >> 1 & 1) << sign_bit;
  return {from_bits<V>(bits_of(select(odd, c, s)) ^ sine_sign), from_bits<V>(bits_of(select(odd, s, c)) ^ cosine_sign)};
}

template <class V>
inline SinCos<V> sin_cos(V x) {
  if (all_of<V>(is_within_limit(x))) [[likely]]
    return sin_cos_within_limit(x);
  SinCos<V> result;
  for (int i = 0; i < Traits<V>::lanes; ++i) {
    result.sin[i] = static_cast<Number<V>>(__builtin_sin(static_cast<double>(x[i])));
    result.cos[i] = static_cast<Number<V>>(__builtin_cos(static_cast<double>(x[i])));
  }
  return result;
}

}  // namespace
}  // namespace kinfer::batch
