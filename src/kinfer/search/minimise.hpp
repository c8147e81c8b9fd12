// Any population search by its options: minimise(objective, PsoOptions{.particles = 60}, rng).
#pragma once

#include <variant>

#include "kinfer/search/bpnn_pso.hpp"
#include "kinfer/search/pso.hpp"
#include "kinfer/search/qpso.hpp"

namespace kinfer {

using SearchOptions = std::variant<PsoOptions, QpsoOptions, BpnnPsoOptions>;

/// The same bits for any number of threads.
Outcome minimise(const Objective& objective, const SearchOptions& options, Rng rng, const Observer& observer = {});

}  // namespace kinfer
