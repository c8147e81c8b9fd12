// SPDX-License-Identifier: Apache-2.0
// The search methods for the chain of a link, behind one interface. Each has its own options only.
#pragma once

#include <variant>

#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/identify/programming/bacterial_search.hpp"
#include "kinfer/identify/programming/memetic_search.hpp"

namespace kinfer::identify {

using LinkEngine = std::variant<MemeticProgramming, BacterialProgramming, Enumeration>;

LinkSearchMethod method_of(const LinkEngine& engine);
JointVariableKind terminals_of(const LinkEngine& engine);

/// How the orientations are compared: Euler angles with Euler terminals, else without gimbal lock.
OrientationMetric orientation_metric(const LinkEngine& engine);

/// Whether a link starts from the predicted motion of the chain before it, as in paper 1.
bool continues_chain(const LinkEngine& engine);

struct LinkProblem {
  const std::vector<FrameState>&parent, &child;  ///< of the two sensors, at every row
  std::span<const JointSignal> signals;
  const std::vector<std::size_t>& rows;  ///< that may be fitted
};

struct LinkSolution {
  std::vector<DhLeaf> leaves;
  std::vector<std::size_t> rows;  ///< that were fitted
  std::int64_t evaluations = 0;
  int generations = 0;
  std::vector<double> best, median;  ///< cost of the population after each generation
};

/// Several terminals per link (Euler angles) need bacterial programming.
LinkSolution search_link(const LinkEngine& engine, const LinkProblem& problem, int threads, const Rng& rng,
                         const Observer& observer);

}  // namespace kinfer::identify
