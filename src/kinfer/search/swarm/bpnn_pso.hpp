// SPDX-License-Identifier: Apache-2.0
// BPNN-PSO, paper 2, section 3.2 and figure 5: a neural network is trained on one identification and predicts the
// initial swarm of the next one.
//
// Each particle of the earlier run is one training pair: its initial position, and the optimum of that run. All targets
// of one robot are therefore the same vector, and the network learns this constant with a little scatter: a warm start
// (docs/development/methods/paper2.md).
#pragma once

#include "kinfer/search/swarm/pso.hpp"

namespace kinfer {

enum class NetUse {
  initial_swarm,        ///< the network moves the initial swarm only
  before_every_update,  ///< section 3.2.2 taken literally; it pulls the swarm back to the earlier optimum at each
                        ///< iteration, so that the search cannot converge anywhere else
};

/// Number of hidden nodes of the network.
enum class HiddenNodes {
  figure,    ///< 70, as drawn in figure 3
  formula,   ///< √(m + n) + 10, the largest that the paper's formula gives
  stepwise,  ///< the best of the formula's range and of 20 .. 70, by the error on held-out pairs
};

struct BpnnPsoOptions {
  PsoOptions pso{};
  std::optional<Mlp> net{};  ///< of an earlier run (Outcome::net); none: cold start
  NetUse use = NetUse::initial_swarm;
  HiddenNodes hidden_nodes = HiddenNodes::figure;
  TrainingOptions training{};  ///< of the network that this run returns
};

/// Trains a network on the pairs (column of `initial`, optimum).
Mlp train_on_swarm(const Bounds& box, ConstMatrixRef initial, ConstVectorRef optimum, HiddenNodes nodes,
                   const TrainingOptions& options, int threads, Rng rng);

/// PSO from the swarm that the network predicts from uniformly drawn particles. Outcome::net is trained on this run.
/// The random streams 0 and 1 are those of particle_swarm, 2 is that of the training.
SearchOutcome bpnn_particle_swarm(const Objective& objective, const BpnnPsoOptions& options, Rng rng,
                                  const Observer& observer = {});

}  // namespace kinfer
