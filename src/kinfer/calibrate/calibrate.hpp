// SPDX-License-Identifier: Apache-2.0
// From a nominal model and external measurements to a corrected model, validated on held-out poses.
#pragma once

#include <optional>
#include <variant>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/problem/swarm_options.hpp"
#include "kinfer/evidence/calibration.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer::calibrate {

/// The prior knowledge and the measurements.
struct CalibrationTask {
  Chain nominal;
  Tolerances tolerances;
  std::optional<Instrument> instrument;  ///< absent: the noise is estimated from the residuals
  PoseSet data;
  std::vector<Parameter> extra_parameters{};  ///< additional free parameters: non-geometric terms
  std::optional<Chain> earlier{};             ///< an earlier calibration of this robot: searches start there
  std::vector<Chain>
      robot_population{};  ///< earlier calibrations of robots of this type: their mean and covariance are the prior
};

struct GeometricParameters {};  ///< the complete geometric set with tolerance priors
struct PaperDhParameters {};    ///< paper 2, table 2; base and tool as given
struct NamedParameters {
  std::vector<std::string> names;
};
struct JointOffsetParameters {};  ///< after a collision or a motor replacement: joint offsets, base and tool;
///< CalibrationTask::nominal is the earlier calibration, all other parameters stay fixed
using ParameterChoice = std::variant<GeometricParameters, PaperDhParameters, NamedParameters, JointOffsetParameters>;

struct CrossValidation {
  int folds = 5;
};  ///< every row is held out once; the result is fitted to all rows
struct HeldOutFraction {
  double fraction = 0.2;
};                         ///< random rows are never fitted
struct HeldOutByLabel {};  ///< rows labelled `holdout` in the data are never fitted
using HoldoutChoice = std::variant<CrossValidation, HeldOutFraction, HeldOutByLabel>;

struct CrossValidatedModel {};  ///< geometry, and the non-geometric terms selected by cross-validation
struct FixedModel {
  std::vector<std::string> model_terms;  ///< non-geometric terms, of model_term_names(); empty: geometry only
};
using ModelChoice = std::variant<CrossValidatedModel, FixedModel>;

struct CalibrationOptions {
  ParameterChoice parameters = GeometricParameters{};
  HoldoutChoice holdout =
      CrossValidation{};  ///< labels in the data take precedence over cross-validation, not over a fraction
  ModelChoice model = CrossValidatedModel{};         ///< only with GeometricParameters and without a swarm search
  std::optional<SwarmSearchOptions> swarm_search{};  ///< swarm search (paper 2); none: Levenberg-Marquardt
  int threads = 0;                                   ///< 0: all cores; the result does not depend on it
};

Result<Calibration> calibrate_robot(const CalibrationTask& task, const CalibrationOptions& options, Rng rng,
                                    const Observer& observer = {});

}  // namespace kinfer::calibrate
