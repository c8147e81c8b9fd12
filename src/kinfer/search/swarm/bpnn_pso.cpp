// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/bpnn_pso.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr int nodes_of_figure_3 = 70;

std::vector<int> candidates(Eigen::Index dim) {
  std::vector<int> list;
  for (int a = 1; a <= 10; ++a) list.push_back(hidden_nodes_by_formula(dim, dim, a));
  for (int nodes = 20; nodes <= nodes_of_figure_3; nodes += 10) list.push_back(nodes);
  return list;
}

int select_hidden_nodes(HiddenNodes how, const Bounds& box, ConstMatrixRef inputs, ConstMatrixRef targets,
                        const TrainingOptions& options, int threads, Rng rng) {
  if (how == HiddenNodes::figure) return nodes_of_figure_3;
  if (how == HiddenNodes::formula) return hidden_nodes_by_formula(box.size(), box.size(), 10);
  const std::vector<NodeTrial> trials =
      compare_hidden_nodes(box, box, inputs, targets, candidates(box.size()), options, threads, rng);
  const auto better = [](const NodeTrial& a, const NodeTrial& b) { return a.validation_error < b.validation_error; };
  return std::min_element(trials.begin(), trials.end(), better)->nodes;
}

}  // namespace

Mlp train_on_swarm(const Bounds& box, ConstMatrixRef initial, ConstVectorRef optimum, HiddenNodes nodes,
                   const TrainingOptions& options, int threads, Rng rng) {
  const MatrixXd targets = optimum.replicate(1, initial.cols());
  const int hidden = select_hidden_nodes(nodes, box, initial, targets, options, threads, rng.stream(0));
  return train(initialise_mlp(box, box, hidden, rng.stream(1)), initial, targets, options).net;
}

SearchOutcome bpnn_particle_swarm(const Objective& objective, const BpnnPsoOptions& options, Rng rng,
                                  const Observer& observer) {
  const Bounds& box = objective.bounds;
  PsoOptions pso = options.pso;
  const MatrixXd drawn = pso.initial.size() > 0 ? pso.initial : uniform_swarm(box, pso.particles, rng.stream(0));
  SwarmMap map;
  pso.initial = drawn;
  if (options.net) {
    KINFER_EXPECT(options.net->input_box.size() == box.size(), "a net of {} inputs for {} unknowns",
                  options.net->input_box.size(), box.size());
    pso.initial = clamped(predict(*options.net, drawn), box);
    if (options.use == NetUse::before_every_update)
      map = [&](const MatrixXd& swarm) { return predict(*options.net, swarm); };
  }
  SearchOutcome outcome = particle_swarm(objective, pso, rng, observer, map);
  outcome.net =
      train_on_swarm(box, drawn, outcome.x, options.hidden_nodes, options.training, pso.budget.threads, rng.stream(2));
  return outcome;
}

}  // namespace kinfer
