// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/minimise.hpp"

namespace kinfer {
namespace {

SearchOutcome run(const Objective& objective, const PsoOptions& options, Rng rng, const Observer& observer) {
  return particle_swarm(objective, options, rng, observer);
}
SearchOutcome run(const Objective& objective, const QpsoOptions& options, Rng rng, const Observer& observer) {
  return quantum_swarm(objective, options, rng, observer);
}
SearchOutcome run(const Objective& objective, const BpnnPsoOptions& options, Rng rng, const Observer& observer) {
  return bpnn_particle_swarm(objective, options, rng, observer);
}

}  // namespace

SearchOutcome minimise(const Objective& objective, const SearchOptions& options, Rng rng, const Observer& observer) {
  return std::visit([&](const auto& how) { return run(objective, how, rng, observer); }, options);
}

}  // namespace kinfer
