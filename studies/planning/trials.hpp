// SPDX-License-Identifier: Apache-2.0
// Evaluation of a choice of poses: fits of the chosen poses, evaluated on others.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/plan/plan_poses.hpp"

namespace kinfer::study::planning_study {
using namespace calibrate;
using namespace plan;

constexpr int poses = 15, draws = 20;

struct NamedCriterion {
  Criterion criterion;
  const char* name;
};
constexpr NamedCriterion all_criteria[] = {{Criterion::tool, "tool"}, {Criterion::worst, "worst"}, {Criterion::d, "D"}};

enum class Fitting {
  by_default,           ///< as `kinfer calibrate` does: diagnosis, priors, model selection, gross errors
  plain_least_squares,  ///< geometry alone, tolerances a thousand times as wide, all rows kept
};
constexpr Fitting all_fittings[] = {Fitting::by_default, Fitting::plain_least_squares};
const char* name(Fitting fitting);

struct Errors {
  double mean = 0.0, worst = 0.0;  // [m]
};

/// Errors on `rest` of the fit of `train`.
Errors errors_of(const CalibrationTask& task, Fitting fitting, const PoseSet& train, const PoseSet& rest);

/// Medians over the draws.
Errors medians_of(const std::function<Errors(int draw)>& trial);

/// A line of the table, printed.
std::string row(const std::string& set, Fitting fitting, const std::string& choice, const Errors& e,
                const Errors& random);

/// Robots of several kinds with errors drawn from their tolerances, rigid or not.
std::string simulated_robots();

/// Series B and C of the public UR10 set in `folder`, choosing among their own poses.
Result<std::string> measured_robot(const std::string& folder);

}  // namespace kinfer::study::planning_study
