// SPDX-License-Identifier: Apache-2.0
#include "kinfer/search/swarm/minimise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

SearchDescription describe_population(int particles, const Budget& budget) {
  return {{"particles", fmt::to_string(particles)}, {"iterations", fmt::to_string(budget.max_iterations)}};
}

SearchDescription describe_pso(const PsoOptions& pso) {
  constexpr std::array<std::string_view, 3> boundary{"absorb", "clamp", "open"};
  SearchDescription text = describe_population(pso.particles, pso.budget);
  text.emplace_back("inertia", fmt::to_string(pso.inertia));
  text.emplace_back("own", fmt::to_string(pso.cognitive));
  text.emplace_back("swarm", fmt::to_string(pso.social));
  text.emplace_back("walls", boundary[static_cast<std::size_t>(pso.boundary)]);
  return text;
}

SearchDescription describe_bpnn(const BpnnPsoOptions& bpnn) {
  SearchDescription text = describe_pso(bpnn.pso);
  text.emplace_back("net-use", bpnn.use == NetUse::initial_swarm ? "initial-swarm" : "every-update");
  return text;
}

}  // namespace

std::span<const SwarmMethod> swarm_methods() {
  static const std::array methods{
      SwarmMethod{.name = "pso",
                  .help = "particle swarm",
                  .default_options = PsoOptions{},
                  .run =
                      [](const Objective& objective, const SearchOptions& options, Rng rng, const Observer& observer) {
                        return particle_swarm(objective, std::get<PsoOptions>(options), rng, observer);
                      },
                  .budget = [](SearchOptions& options) -> Budget& { return std::get<PsoOptions>(options).budget; },
                  .particles = [](SearchOptions& options) -> int& { return std::get<PsoOptions>(options).particles; },
                  .initial = [](SearchOptions& options) -> MatrixXd& { return std::get<PsoOptions>(options).initial; },
                  .describe = [](const SearchOptions& options) { return describe_pso(std::get<PsoOptions>(options)); }},
      SwarmMethod{.name = "qpso",
                  .help = "quantum-behaved particle swarm",
                  .default_options = QpsoOptions{},
                  .run =
                      [](const Objective& objective, const SearchOptions& options, Rng rng, const Observer& observer) {
                        return quantum_swarm(objective, std::get<QpsoOptions>(options), rng, observer);
                      },
                  .budget = [](SearchOptions& options) -> Budget& { return std::get<QpsoOptions>(options).budget; },
                  .particles = [](SearchOptions& options) -> int& { return std::get<QpsoOptions>(options).particles; },
                  .initial = [](SearchOptions& options) -> MatrixXd& { return std::get<QpsoOptions>(options).initial; },
                  .describe =
                      [](const SearchOptions& options) {
                        const auto& qpso = std::get<QpsoOptions>(options);
                        return describe_population(qpso.particles, qpso.budget);
                      }},
      SwarmMethod{
          .name = "bpnn-pso",
          .help = "particle swarm that starts from the network of an earlier run",
          .default_options = BpnnPsoOptions{},
          .takes_initial_swarm = false,
          .run =
              [](const Objective& objective, const SearchOptions& options, Rng rng, const Observer& observer) {
                return bpnn_particle_swarm(objective, std::get<BpnnPsoOptions>(options), rng, observer);
              },
          .budget = [](SearchOptions& options) -> Budget& { return std::get<BpnnPsoOptions>(options).pso.budget; },
          .particles = [](SearchOptions& options) -> int& { return std::get<BpnnPsoOptions>(options).pso.particles; },
          .initial = [](SearchOptions& options) -> MatrixXd& { return std::get<BpnnPsoOptions>(options).pso.initial; },
          .describe = [](const SearchOptions& options) { return describe_bpnn(std::get<BpnnPsoOptions>(options)); }},
  };
  static_assert(methods.size() == std::variant_size_v<SearchOptions>, "one row per search");
  return methods;
}

const SwarmMethod& method_of(const SearchOptions& options) {
  const std::span<const SwarmMethod> methods = swarm_methods();
  const auto row =
      std::ranges::find_if(methods, [&](const SwarmMethod& m) { return m.default_options.index() == options.index(); });
  KINFER_EXPECT(row != methods.end(), "no search has the options {}", options.index());
  return *row;
}

const SwarmMethod* method_named(std::string_view name) {
  const std::span<const SwarmMethod> methods = swarm_methods();
  const auto row = std::ranges::find(methods, name, &SwarmMethod::name);
  return row == methods.end() ? nullptr : &*row;
}

SearchOptions with_budget(SearchOptions options, const Budget& budget) {
  method_of(options).budget(options) = budget;
  return options;
}

SearchDescription describe(const SearchOptions& options) {
  return method_of(options).describe(options);
}

SearchOutcome minimise(const Objective& objective, const SearchOptions& options, Rng rng, const Observer& observer) {
  return method_of(options).run(objective, options, rng, observer);
}

}  // namespace kinfer
