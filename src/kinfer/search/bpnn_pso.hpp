// BPNN-PSO, paper 2, section 3.2 and figure 5: a net learns from one identification where swarms of this robot end, and
// says where the next swarm shall begin.
//
// Each of the particles of the earlier run is one training pair: its first position, and that run's optimum. So all
// targets of one robot are the same vector, and the net learns this constant with a little scatter: a warm start
// (METHODS, section G).
#pragma once

#include "kinfer/search/pso.hpp"

namespace kinfer {

enum class NetUse {
  initial_swarm,        ///< the net moves the first swarm only
  before_every_update,  ///< the literal reading of section 3.2.2; it pulls the swarm back to the earlier optimum at
                        ///< each iteration and so keeps the search from ending anywhere else
};

/// How many hidden nodes a net gets.
enum class HiddenNodes {
  figure,    ///< 70, as drawn in figure 3
  formula,   ///< √(m + n) + 10, the largest that the paper's formula gives
  stepwise,  ///< the best of the formula's range and of 20 .. 70, judged on pairs that were not trained
};

struct BpnnPsoOptions {
  PsoOptions pso{};
  std::optional<Mlp> net{};  ///< of an earlier run (Outcome::net); none: this run starts cold
  NetUse use = NetUse::initial_swarm;
  HiddenNodes hidden_nodes = HiddenNodes::figure;
  TrainingOptions training{};  ///< of the net that this run leaves behind
};

/// Net trained on the pairs (column of `initial`, optimum).
Mlp learn(const Bounds& box, ConstMatrixRef initial, ConstVectorRef optimum, HiddenNodes nodes,
          const TrainingOptions& options, int threads, Rng rng);

/// PSO from the swarm that the net predicts from evenly drawn particles. Outcome::net is trained on this run. Streams 0
/// and 1 are those of particle_swarm, 2 is the training's.
Outcome bpnn_particle_swarm(const Objective& objective, const BpnnPsoOptions& options, Rng rng,
                            const Observer& observer = {});

}  // namespace kinfer
