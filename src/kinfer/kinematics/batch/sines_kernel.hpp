// SPDX-License-Identifier: Apache-2.0
// The parameters of one candidate, with vectorised sines of its angles. Included by the kernel files only.
#pragma once

#include "kinfer/base/pack_kernel.hpp"
#include "kinfer/kinematics/batch/kernel_interface.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

/// Sines and cosines of any number of angles.
template <class V>
void sines(const double* angles, int count, double* cosines, double* sines) {
  constexpr int lanes = Traits<V>::lanes;
  int k = 0;
  for (; k + lanes <= count; k += lanes) {
    const SinCos<V> pack = sin_cos(load<V>(angles + k));
    store(cosines + k, pack.cos), store(sines + k, pack.sin);
  }
  V rest = broadcast<V>(0.0);
  for (int lane = 0; k + lane < count; ++lane) rest[lane] = angles[k + lane];
  const SinCos<V> pack = sin_cos(rest);
  for (int lane = 0; k + lane < count; ++lane) cosines[k + lane] = pack.cos[lane], sines[k + lane] = pack.sin[lane];
}

class Sines {
 public:
  /// `memory`: sines_workspace(angles, lanes) doubles, which must outlive the result.
  template <class V>
  static Sines of(const Candidate& at, double* memory) {
    constexpr int lanes = Traits<V>::lanes;
    const int padded = round_up(at.angle_count, lanes);
    double *angles = memory, *cosines = angles + padded, *sines = cosines + padded;
    for (int k = 0; k < padded; ++k) angles[k] = k < at.angle_count ? at.x[at.angles[k]] : 0.0;
    for (int k = 0; k < padded; k += lanes) {
      const SinCos<V> pack = sin_cos(load<V>(angles + k));
      store(cosines + k, pack.cos), store(sines + k, pack.sin);
    }
    return Sines(at.x, cosines, sines);
  }

  double value(const Value& v) const { return v.parameter < 0 ? v.constant : x_[v.parameter]; }
  double cos(const Value& v) const { return v.angle < 0 ? v.cos : cosines_[v.angle]; }
  double sin(const Value& v) const { return v.angle < 0 ? v.sin : sines_[v.angle]; }

 private:
  Sines(const double* x, const double* cosines, const double* sines) : x_(x), cosines_(cosines), sines_(sines) {}

  const double *x_, *cosines_, *sines_;
};

}  // namespace
}  // namespace kinfer::batch
