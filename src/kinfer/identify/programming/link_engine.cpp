// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/programming/link_engine.hpp"

namespace kinfer::identify {
namespace {

LinkSolution solution_of(StructureSearchOutcome found) {
  return {.leaves = std::move(found.leaves),
          .rows = {},
          .evaluations = found.evaluations,
          .generations = found.generations,
          .best = std::move(found.best_history),
          .median = std::move(found.median_history)};
}

LinkSolution search_with(MemeticProgramming engine, const LinkProblem& p, int threads, const Rng& rng,
                         const Observer& observer) {
  engine.bacteria.threads = threads;
  return solution_of(search_memetic(p.parent, p.child, p.signals, p.rows, engine, rng, observer));
}

LinkSolution search_with(BacterialProgramming engine, const LinkProblem& p, int threads, const Rng& rng,
                         const Observer& observer) {
  engine.bacteria.threads = threads;
  LinkEvolution found = search_bacterial(p.parent, p.child, p.signals, p.rows, engine, rng, observer);
  return {.leaves = leaves(found.best),
          .rows = {},
          .evaluations = found.evaluations,
          .generations = found.generations,
          .best = std::move(found.best_history),
          .median = std::move(found.median_history)};
}

LinkSolution search_with(const Enumeration& engine, const LinkProblem& p, int threads, const Rng&,
                         const Observer& observer) {
  return solution_of(search_exhaustive(p.parent, p.child, p.signals, p.rows, engine, threads, observer));
}

}  // namespace

LinkSearchMethod method_of(const LinkEngine& engine) {
  if (std::holds_alternative<MemeticProgramming>(engine)) return LinkSearchMethod::memetic;
  return continues_chain(engine) ? LinkSearchMethod::bacterial : LinkSearchMethod::enumeration;
}

JointVariableKind terminals_of(const LinkEngine& engine) {
  const auto* bacterial = std::get_if<BacterialProgramming>(&engine);
  return bacterial ? bacterial->terminals : JointVariableKind::hinge;
}

OrientationMetric orientation_metric(const LinkEngine& engine) {
  return orientation_metric(terminals_of(engine));
}

bool continues_chain(const LinkEngine& engine) {
  return std::holds_alternative<BacterialProgramming>(engine);
}

LinkSolution search_link(const LinkEngine& engine, const LinkProblem& problem, int threads, const Rng& rng,
                         const Observer& observer) {
  LinkSolution solution =
      std::visit([&](const auto& one) { return search_with(one, problem, threads, rng, observer); }, engine);
  const int rows = std::visit([](const auto& one) { return one.rows; }, engine);
  solution.rows = thin_rows(problem.rows, static_cast<std::size_t>(rows));
  return solution;
}

}  // namespace kinfer::identify
