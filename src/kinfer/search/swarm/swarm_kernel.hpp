// SPDX-License-Identifier: Apache-2.0
// Eqs. (9) and (10) of paper 2 for one particle, for files that are each compiled for one instruction set. Plain
// multiplications and additions, none fused: every processor gives the same bits.
#pragma once

namespace kinfer::search {

/// What all particles of an iteration share.
struct SwarmStep {
  int dim = 0;
  double inertia = 0.0, cognitive = 0.0, social = 0.0;  ///< w, c1, c2
  const double* swarm_best = nullptr;
  const double* max_velocity = nullptr;             ///< largest |v| of each number
  const double *lower = nullptr, *upper = nullptr;  ///< infinite where there is no bound
  bool absorbs = false;                             ///< a bound stops the velocity towards it
};

/// `pairs`: r1 and r2 of each number; `own_best`: dim; x and v: dim, in place.
using SwarmKernel = void (*)(const SwarmStep& step, const double* pairs, const double* own_best, double* x, double* v);

namespace {  // one copy per kernel file, compiled for its instruction set

[[gnu::always_inline]] inline double within(double value, double low, double high) {
  const double above = value < low ? low : value;
  return high < above ? high : above;
}

[[maybe_unused]] void move_particle(const SwarmStep& step, const double* __restrict pairs,
                                    const double* __restrict own_best, double* __restrict x, double* __restrict v) {
  const double w = step.inertia, own = step.cognitive, swarm = step.social;
  const bool keeps_velocity = !step.absorbs;
  const double* __restrict best = step.swarm_best, * __restrict max_velocity = step.max_velocity;
  const double* __restrict lower = step.lower, * __restrict upper = step.upper;
  for (int d = 0; d < step.dim; ++d) {
    const double attraction = own * pairs[2 * d] * (own_best[d] - x[d]) + swarm * pairs[2 * d + 1] * (best[d] - x[d]);
    const double speed = within(w * v[d] + attraction, -max_velocity[d], max_velocity[d]);
    const double to = x[d] + speed, at = within(to, lower[d], upper[d]);
    v[d] = ((at == to) | keeps_velocity) ? speed : 0.0;
    x[d] = at;
  }
}

}  // namespace

#if defined(__x86_64__)
extern const SwarmKernel swarm_avx2, swarm_avx512;
#endif

}  // namespace kinfer::search
