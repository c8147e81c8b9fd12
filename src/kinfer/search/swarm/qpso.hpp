// SPDX-License-Identifier: Apache-2.0
// Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004; mean-best form, Sun, Xu and Feng 2004):
//
//   p = phi · own best + (1 − phi) · swarm's best          phi, u uniform in (0, 1), for each number
//   x = p ± beta |mean best − x| ln(1/u)                   mean best: mean of all particles' own bests
//
// No velocities; one setting, the contraction beta.
#pragma once

#include "kinfer/search/swarm/objective.hpp"

namespace kinfer {

struct QpsoOptions {
  int particles = 200;
  double contraction = 1.0;        ///< beta at the start; above 1.78 the swarm disperses
  double final_contraction = 0.5;  ///< beta at the end of the schedule, reached linearly, then constant
  int schedule = 1000;             ///< iterations of the schedule; few: contracts early
  MatrixXd initial{};              ///< dim x particles; empty: drawn uniformly from the box
  Budget budget{};
};

/// Particle p of iteration k draws from `rng.stream(1).stream(k).stream(p)`. Particles that leave the box are
/// clamped to it.
SearchOutcome quantum_swarm(const Objective& objective, const QpsoOptions& options, Rng rng,
                            const Observer& observer = {});

}  // namespace kinfer
