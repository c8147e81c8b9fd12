// SPDX-License-Identifier: Apache-2.0
// All population searches behind one interface: minimise(objective, PsoOptions{.particles = 60}, rng), and a table with
// one row per search.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "kinfer/search/swarm/bpnn_pso.hpp"
#include "kinfer/search/swarm/pso.hpp"
#include "kinfer/search/swarm/qpso.hpp"

namespace kinfer {

/// The options select the search.
using SearchOptions = std::variant<PsoOptions, QpsoOptions, BpnnPsoOptions>;

/// Options that have an effect, by name, as text.
using SearchDescription = std::vector<std::pair<std::string, std::string>>;

/// A population search. The functions take options of this search only.
struct SwarmMethod {
  std::string_view name;            ///< as in --method
  std::string_view help;            ///< a few words for the help text
  SearchOptions default_options{};  ///< their alternative identifies the search
  bool takes_initial_swarm = true;  ///< false: its network maps uniformly drawn particles

  SearchOutcome (*run)(const Objective& objective, const SearchOptions& options, Rng rng,
                       const Observer& observer) = nullptr;
  Budget& (*budget)(SearchOptions& options) = nullptr;
  int& (*particles)(SearchOptions& options) = nullptr;
  MatrixXd& (*initial)(SearchOptions& options) = nullptr;  ///< initial swarm, dim x particles; empty: drawn
  SearchDescription (*describe)(const SearchOptions& options) = nullptr;
};

/// The table, in the order of the help text.
std::span<const SwarmMethod> swarm_methods();

/// The row of these options.
const SwarmMethod& method_of(const SearchOptions& options);

/// The row of that name; null for another name.
const SwarmMethod* method_named(std::string_view name);

/// The same search with another budget.
SearchOptions with_budget(SearchOptions options, const Budget& budget);

/// The options that have an effect, for provenance: "particles" -> "200".
SearchDescription describe(const SearchOptions& options);

/// The same bits for any number of threads.
SearchOutcome minimise(const Objective& objective, const SearchOptions& options, Rng rng,
                       const Observer& observer = {});

}  // namespace kinfer
