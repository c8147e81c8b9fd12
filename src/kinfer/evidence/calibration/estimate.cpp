// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/estimate.hpp"

#include <algorithm>
#include <array>

namespace kinfer {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 3> undetermined_names{"no_effect", "weaker_than_tolerance", "confounded"};
constexpr std::array<std::string_view, 4> method_names{"lm", "pso", "qpso", "bpnn-pso"};
constexpr std::array<std::string_view, 4> swarm_names{"cold", "nominal swarm", "warm start", "net"};

}  // namespace

std::string_view name(Undetermined reason) {
  return undetermined_names[static_cast<std::size_t>(reason)];
}

std::string_view name(SearchMethod method) {
  return method_names[static_cast<std::size_t>(method)];
}

std::optional<SearchMethod> search_method(std::string_view name) {
  const auto at = std::ranges::find(method_names, name);
  if (at == method_names.end()) return std::nullopt;
  return static_cast<SearchMethod>(at - method_names.begin());
}

std::string_view name(InitialSwarm swarm) {
  return swarm_names[static_cast<std::size_t>(swarm)];
}

}  // namespace kinfer
