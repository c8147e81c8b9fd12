// From a nominal model and outside measurements to a corrected model, proven on poses that were not fitted.
#pragma once

#include <optional>
#include <variant>

#include "kinfer/base/observer.hpp"
#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/calibrate/population_options.hpp"
#include "kinfer/evidence/calibration.hpp"
#include "kinfer/measurement/pose_set.hpp"
#include "kinfer/measurement/split.hpp"

namespace kinfer {

/// All that is known beforehand, and what was measured.
struct CalibrateTask {
  Chain nominal;
  Tolerances tolerances;
  std::optional<Instrument> instrument;  ///< absent: judged from the residuals
  PoseSet data;
  std::vector<Parameter> further{};  ///< freed besides the chosen ones: what goes beyond geometry
  std::optional<Chain> earlier{};    ///< an earlier calibration of this robot: searches start there
  std::vector<Chain> fleet{};  ///< earlier calibrations of robots of this kind: their mean and spread are the prior
};

struct AutoParameters {};     ///< the complete geometric set with tolerance priors
struct Paper24Parameters {};  ///< paper 2, table 2; base and tool as given
struct NamedParameters {
  std::vector<std::string> names;
};
struct OffsetParameters {};  ///< after a knock or a motor change: joint offsets, base and tool; CalibrateTask::nominal
                             ///< is the earlier calibration, and all else stays as it found it
using ParameterChoice = std::variant<AutoParameters, Paper24Parameters, NamedParameters, OffsetParameters>;

struct CrossValidation {
  int folds = 5;
};  ///< every row is held out once; the result is fitted on all rows
struct HeldOutFraction {
  double fraction = 0.2;
};                         ///< random rows are never fitted
struct HeldOutByLabel {};  ///< rows labelled `holdout` in the data are never fitted
using HoldoutChoice = std::variant<CrossValidation, HeldOutFraction, HeldOutByLabel>;

struct AutoModel {};  ///< geometry and what cross-validation shows to help beyond it
struct NamedModel {
  std::vector<std::string> rungs;  ///< beyond geometry, of rung_names(); empty: geometry alone
};
using ModelChoice = std::variant<AutoModel, NamedModel>;

struct CalibrateOptions {
  ParameterChoice parameters = AutoParameters{};
  HoldoutChoice holdout =
      CrossValidation{};            ///< where the data carry labels, those rule unless a fraction is asked for
  ModelChoice model = AutoModel{};  ///< only with AutoParameters and without a population
  std::optional<PopulationOptions> population{};  ///< search by a population (paper 2); none: Levenberg-Marquardt
  int threads = 0;                                ///< 0: all cores; the result does not depend on it
};

Result<Calibration> calibrate(const CalibrateTask& task, const CalibrateOptions& options, Rng rng,
                              const Observer& observer = {});

}  // namespace kinfer
