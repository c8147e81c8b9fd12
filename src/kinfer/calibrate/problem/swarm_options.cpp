// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/problem/swarm_options.hpp"

namespace kinfer::calibrate {
namespace {

/// The options of the particle swarm that a search runs.
template <class Search>
auto& swarm_of(Search& search) {
  if constexpr (requires { search.pso; })
    return search.pso;
  else
    return search;
}

}  // namespace

SearchMethod method(const SearchOptions& search) {
  constexpr SearchMethod methods[] = {SearchMethod::pso, SearchMethod::qpso, SearchMethod::bpnn_pso};
  return methods[search.index()];  // in the order of the variant
}

int particles(const SearchOptions& search) {
  return std::visit([](const auto& options) { return swarm_of(options).particles; }, search);
}

Budget& budget(SearchOptions& search) {
  return std::visit([](auto& options) -> Budget& { return swarm_of(options).budget; }, search);
}

const Budget& budget(const SearchOptions& search) {
  return std::visit([](const auto& options) -> const Budget& { return swarm_of(options).budget; }, search);
}

}  // namespace kinfer::calibrate
