// SPDX-License-Identifier: Apache-2.0
// Particle swarm optimisation (Kennedy and Eberhart 1995, inertia weight by Shi and Eberhart 1998), as in paper 2:
//
//   v(t+1) = w v(t) + c1 r1 (own best − x(t)) + c2 r2 (swarm's best − x(t))     eq. (9)
//   x(t+1) = x(t) + v(t+1)                                                       eq. (10)
//
// All particles move by the bests of the iteration before (step 6 of section 3.1), so their order does not matter.
#pragma once

#include "kinfer/search/swarm/objective.hpp"

namespace kinfer {

enum class RandomNumbers { per_dimension, per_particle };  ///< r1 and r2 of eq. (9): vectors, or one number each

/// Boundary handling: what happens to a particle that leaves the box.
enum class BoundaryHandling {
  absorb,  ///< clamped to the bound, the velocity towards it set to zero
  clamp,   ///< clamped to the bound, velocity kept: in many dimensions the whole swarm runs into some bound and sticks
           ///< to it, because all own bests lie there
  open,    ///< no bound
};

struct PsoOptions {
  int particles = 200;          ///< paper 2, section 3.1.2
  double inertia = 0.8;         ///< w; near 1 explores and hardly contracts, small contracts early. Paper 2 prints 0.9
  double final_inertia = -1.0;  ///< w at max_iterations, reached linearly; negative: constant
  double cognitive = 0.5;       ///< c1
  double social = 1.25;         ///< c2
  double velocity_limit = 0.0;  ///< largest |v| of each number, as a fraction of the box's width; 0: none
  RandomNumbers random_numbers = RandomNumbers::per_dimension;
  BoundaryHandling boundary = BoundaryHandling::absorb;
  MatrixXd initial{};  ///< dim x particles; empty: drawn uniformly from the box. Velocities start at zero
  Budget budget{};
};

/// The weights printed in paper 2: w = 0.9 with c1 + c2 = 1.75. They are at the limit of stability, so that the swarm
/// hardly contracts (docs/development/methods/paper2.md).
inline PsoOptions pso_as_printed() {
  PsoOptions options;
  options.inertia = 0.9;
  return options;
}

/// Maps the swarm before every update: the hook of BPNN-PSO. Empty: no map.
using SwarmMap = std::function<MatrixXd(const MatrixXd&)>;

/// Particle p of iteration k draws from `rng.stream(1).stream(k).stream(p)`, the initial swarm from `rng.stream(0)`.
SearchOutcome particle_swarm(const Objective& objective, const PsoOptions& options, Rng rng,
                             const Observer& observer = {}, const SwarmMap& before_every_update = {});

}  // namespace kinfer
