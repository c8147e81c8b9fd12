// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/validation_errors.hpp"

#include <cmath>
#include <limits>

#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Mean error of each row, of the primary kind of measurement [m]; NaN where it has none.
std::vector<double> error_of_rows(const std::vector<double>& errors, const PoseSet& rows) {
  std::vector<double> sum(rows.rows(), 0.0), count(rows.rows(), 0.0);
  const auto kind = primary_measurement_kind(rows);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const int row = residual_kind(*kind).row(rows, i);
    sum[row] += errors[i], count[row] += 1.0;
  }
  for (std::size_t row = 0; row < sum.size(); ++row) sum[row] = count[row] > 0.0 ? sum[row] / count[row] : not_measured;
  return sum;
}

std::vector<double> error_of_rows(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& rows) {
  return error_of_rows(primary_errors(chain, fitted_rows, rows), rows);
}

void append(std::vector<double>& to, const std::vector<double>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Errors of one chain, or of the corresponding chains of all validation fits.
struct ErrorLists {
  std::vector<double> position, orientation;

  void add(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& rows) {
    append(position, primary_errors(chain, fitted_rows, rows));
    append(orientation, orientation_errors(chain, rows));
  }
  void write_statistics(ChainFit& fit, ErrorStatistics TrainHoldout::*which) const {
    fit.position.*which = error_statistics(position);
    fit.orientation.*which = error_statistics(orientation);
  }
};

void fill_train(ChainFit& fit, const Chain& chain, const PoseSet& fitted_rows, const PoseSet& rows) {
  ErrorLists errors;
  errors.add(chain, fitted_rows, rows);
  errors.write_statistics(fit, &TrainHoldout::train);
}

/// Statistics over the held-out rows without `skipped`.
void fill_held_out(Calibration& calibration, const EvaluationInputs& evaluated, const std::vector<int>& skipped,
                   ErrorStatistics TrainHoldout::*which) {
  ErrorLists nominal, before, after;
  const PoseSet no_rows;
  for (std::size_t i = 0; i < evaluated.fits.size(); ++i) {
    const Split& split = evaluated.plan.validation_splits[i];
    const PoseSet rows = select(evaluated.data, without(split.holdout, skipped));
    const PoseSet fitted_rows = select(evaluated.data, split.train);
    nominal.add(evaluated.nominal, no_rows, rows);
    before.add(evaluated.fits[i].before, fitted_rows, rows);
    after.add(evaluated.fits[i].after.chain, fitted_rows, rows);
  }
  nominal.write_statistics(calibration.nominal, which);
  before.write_statistics(calibration.before, which);
  after.write_statistics(calibration.after, which);
}

void fill_rows(Calibration& calibration, const EvaluationInputs& evaluated) {
  const PoseSet fitted = select(evaluated.data, evaluated.plan.fitted);
  const std::vector<double> before = error_of_rows(evaluated.frames_only, fitted, evaluated.data),
                            after = error_of_rows(calibration.estimate.chain, fitted, evaluated.data);
  for (int row = 0; row < evaluated.data.rows(); ++row)
    calibration.rows.push_back({row, before[row], after[row], after[row], false});
  for (std::size_t i = 0; i < evaluated.fits.size(); ++i) {
    const Split& split = evaluated.plan.validation_splits[i];
    const PoseSet rows = select(evaluated.data, split.holdout), fitted_rows = select(evaluated.data, split.train);
    const std::vector<double> holdout_before = error_of_rows(evaluated.fits[i].before, fitted_rows, rows),
                              holdout_after = error_of_rows(evaluated.fits[i].after.chain, fitted_rows, rows);
    for (std::size_t k = 0; k < split.holdout.size(); ++k) {
      RowErrors& entry = calibration.rows[split.holdout[k]];
      entry.before = holdout_before[k];
      entry.after = holdout_after[k];
      entry.held_out = true;
    }
  }
}

}  // namespace

std::optional<MeasurementKind> primary_measurement_kind(const PoseSet& data) {
  for (const ResidualKind& kind : residual_kinds())
    if (kind.traits.observes.tool_position && kind.count(data) > 0) return kind.kind;
  return std::nullopt;
}

std::vector<double> primary_errors(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& evaluated) {
  const auto kind = primary_measurement_kind(evaluated);
  if (!kind) return {};
  return position_errors(*kind, with_unfitted_fixtures(chain, fitted_rows, evaluated), evaluated);
}

void fill_error_statistics(Calibration& calibration, const EvaluationInputs& evaluated) {
  const std::vector<int> inliers = without_outliers(evaluated.plan.fitted, calibration.estimate.outliers);
  const PoseSet rows = select(evaluated.data, inliers), no_rows;
  fill_train(calibration.nominal, evaluated.nominal, no_rows, rows);
  fill_train(calibration.before, evaluated.frames_only, rows, rows);
  fill_train(calibration.after, calibration.estimate.chain, rows, rows);
  fill_held_out(calibration, evaluated, evaluated.gross_errors, &TrainHoldout::holdout);
  fill_held_out(calibration, evaluated, {}, &TrainHoldout::holdout_all_rows);
  fill_rows(calibration, evaluated);
  calibration.measured = primary_measurement_kind(evaluated.data).value_or(kind_of<OrientationMeasurement>);
}

std::optional<double> expected_holdout_rms(const EvaluationInputs& evaluated) {
  const auto primary = primary_measurement_kind(evaluated.data);
  if (!evaluated.instrument || !primary) return std::nullopt;
  const ResidualKind& kind = residual_kind(*primary);
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < evaluated.fits.size(); ++i) {
    const Estimate& fit = evaluated.fits[i].after;
    const PoseSet rows =
        select(evaluated.data, without(evaluated.plan.validation_splits[i].holdout, evaluated.gross_errors));
    const Chain chain =
        with_unfitted_fixtures(fit.chain, select(evaluated.data, evaluated.plan.validation_splits[i].train), rows);
    const Weights weights = weights_of(rows, *evaluated.instrument);
    const EvaluatedPoses at = evaluate_poses(chain, fit.parameters, rows, Derivative::yes);
    const FixtureColumns columns = fixture_columns(chain, fit.parameters);
    const ResidualContext scene{chain, rows, at, columns};
    VectorXd residual = VectorXd::Zero(3);
    MatrixXd jacobian = MatrixXd::Zero(3, fit.parameters.free_count());
    for (std::size_t k = 0; k < kind.count(rows); ++k) {
      BlockRows out{residual, &jacobian, 0};
      kind.write(scene, k, out);
      const double metres = kind.metres(scene, k);
      squares += metres * metres *
                 (weights.of(*primary)[k].head(kind.size).squaredNorm() +
                  propagated_covariance(jacobian.topRows(kind.size), fit.covariance).trace());
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional(std::sqrt(squares / count)) : std::nullopt;
}

}  // namespace kinfer::calibrate
