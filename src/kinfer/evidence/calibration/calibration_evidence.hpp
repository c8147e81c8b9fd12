// SPDX-License-Identifier: Apache-2.0
// evidence.json of `calibrate`, as values: all that the report shows. SI throughout; numbers for drawings are rounded.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/facts/advice.hpp"
#include "kinfer/evidence/facts/records.hpp"
#include "kinfer/kinematics/chain_view.hpp"

namespace kinfer {

// Members without a value stand for keys that files of earlier versions lack.

struct CalibrationAdviceRecord {
  Advice text{};
  std::optional<CalibrationAdviceKind> kind{};
  FactValues values{};
};

struct OutlierRecord {
  Outlier outlier{};
  std::string reason{};
};

/// A model that was fitted, or skipped, on top of those accepted before it.
struct ModelRecord {
  std::string name{}, description{};
  ErrorStatistics train{}, holdout{};  ///< [m]; n = 0 where it was skipped
  int parameter_count = 0, determined_count = 0;
  std::vector<std::string> undetermined_parameters{};
  bool selected = false, skipped = false;
  std::string reason{};
  std::optional<Decision> decision{};
  std::optional<MissingData> missing{};
  std::optional<ErrorChange> interpolation{}, extrapolation{};  ///< of a term that was tested
  double log_evidence_gain = 0.0, contribution = 0.0;           ///< [1], [m] as in SelectionStep
};

struct ModelSelectionRecord {
  std::string selected{};
  std::vector<ModelRecord> models{};
};

struct SearchRecord {
  SearchSummary summary{};  ///< without the network
  std::string stop_sentence{};
};

struct ChainRecords {
  ChainView nominal{}, before{}, calibrated{};
};

/// Data of the drawings, by row of the pose set; lengths rounded to 0.1 µm.
struct PictureRecord {
  ChainRecords chains{};
  MatrixXd joints{};  ///< dof x rows, [rad] or [m]
  std::vector<PlotRow> rows{};
  std::vector<WorkspacePoint> workspace{};  ///< without joint positions
};

struct CalibrationEvidence {
  std::string robot{};
  VerdictRecord verdict{};
  std::optional<CalibrationReason> reason{};
  std::vector<CalibrationAdviceRecord> next{};
  std::vector<std::string> notes{};
  std::vector<CalibrationNote> note_facts{};
  std::optional<UnknownRobotEvidence> unknown_robot{};
  std::vector<FindingRecord> findings{};
  std::string holdout{};                          ///< hold-out scheme: "5-fold cross-validation"
  std::vector<int> gross_error_rows{};            ///< excluded from all hold-out figures
  std::string measured = "position";              ///< quantity that the errors refer to
  std::optional<MeasurementKind> measurement{};   ///< its kind
  std::optional<double> expected_holdout_rms{};   ///< [m] from instrument and fit
  std::optional<double> noise_holdout_rms{};      ///< [m] if the noise of the instrument were all that is wrong
  std::optional<double> predicted_holdout_rms{};  ///< [m] with the model error
  std::optional<double> chance_of_improvement{};  ///< probability that a model that is no better looks as good
  std::optional<UnobservedLengths> unobserved_lengths{};
  std::optional<Contradiction> contradiction{};
  ChainFit nominal{}, before{}, after{};
  std::optional<AccuracyStatistics> iso9283{};  ///< [m]; none without measured tool points
  double predicted_error = 0.0;                 ///< [m]
  double sigma = 0.0, sigma_angle = 0.0;        ///< [m], [rad]
  std::optional<double> chi2_per_n{};
  std::vector<ParameterEstimate> parameters{};
  Identifiability identifiability{};
  std::vector<std::string> undetermined{};  ///< sentences on its groups
  std::vector<OutlierRecord> outliers{};
  ModelSelectionRecord model{};
  SearchRecord search{};
  MatrixXd covariance{};  ///< of `parameters`, SI
  std::vector<RowErrors> rows{};
  PictureRecord picture{};
  ProvenanceRecord provenance{};
};

}  // namespace kinfer
