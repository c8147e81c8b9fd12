// SPDX-License-Identifier: Apache-2.0
// How a calibration is done: which parameters, which rows are held out, which model terms, which search.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/calibrate/problem/swarm_options.hpp"
#include "kinfer/calibrate/problem/task.hpp"
#include "kinfer/evidence/calibration/model_selection.hpp"

namespace kinfer::calibrate {

struct GeometricParameters {};  ///< the complete geometric set with tolerance priors
struct PaperDhParameters {};    ///< paper 2, table 2; base and tool as given
struct NamedParameters {
  std::vector<std::string> names;
};
/// After a collision or a motor replacement: joint offsets, base and tool. All other parameters stay those of
/// CalibrationTask::earlier, or of `nominal` where there is none.
struct JointOffsetParameters {};
using ParameterChoice = std::variant<GeometricParameters, PaperDhParameters, NamedParameters, JointOffsetParameters>;

/// Every row is held out once; the result is fitted to all rows.
struct CrossValidation {
  std::optional<int> folds{};  ///< none: five; with JointOffsetParameters and few rows, one per row
};
struct HeldOutFraction {
  double fraction = 0.2;
};                         ///< random rows are never fitted
struct HeldOutByLabel {};  ///< rows labelled `holdout` in the data are never fitted
using HoldoutChoice = std::variant<CrossValidation, HeldOutFraction, HeldOutByLabel>;

struct AutomaticModel {};  ///< geometry, and the non-geometric terms that the data support, weighed by evidence
struct FixedModel {
  std::vector<Term> terms{};  ///< non-geometric terms; empty: geometry only
};
using ModelChoice = std::variant<AutomaticModel, FixedModel>;

/// "auto", "geometry", or names of terms joined by "+". An error lists the known names.
Result<ModelChoice> parse_model_choice(const std::string& text);

struct CalibrationOptions {
  ParameterChoice parameters = GeometricParameters{};
  HoldoutChoice holdout =
      CrossValidation{};  ///< labels in the data take precedence over cross-validation, not over a fraction
  ModelChoice model = AutomaticModel{};  ///< of GeometricParameters found by least squares; else geometry only
  std::optional<SwarmSearchOptions> swarm_search{};  ///< swarm search (paper 2); none: Levenberg-Marquardt
  int threads = 0;                                   ///< 0: all cores; the result does not depend on it
};

/// Whether model terms can be added: not to a subset of the parameters, and not in a swarm search.
bool allows_model_terms(const CalibrationOptions& options);

/// An error where options contradict each other or the task, or would have no effect.
Result<void> check_options(const CalibrationTask& task, const CalibrationOptions& options);

/// The options that have an effect, as they are given on the command line.
std::vector<std::pair<std::string, std::string>> describe(const CalibrationTask& task,
                                                          const CalibrationOptions& options);

}  // namespace kinfer::calibrate
