// SPDX-License-Identifier: Apache-2.0
// Any population search by its options: minimise(objective, PsoOptions{.particles = 60}, rng).
#pragma once

#include <variant>

#include "kinfer/search/swarm/bpnn_pso.hpp"
#include "kinfer/search/swarm/pso.hpp"
#include "kinfer/search/swarm/qpso.hpp"

namespace kinfer {

using SearchOptions = std::variant<PsoOptions, QpsoOptions, BpnnPsoOptions>;

/// The same bits for any number of threads.
SearchOutcome minimise(const Objective& objective, const SearchOptions& options, Rng rng,
                       const Observer& observer = {});

}  // namespace kinfer
