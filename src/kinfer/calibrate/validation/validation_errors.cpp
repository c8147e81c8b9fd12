// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/validation/validation_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <type_traits>

#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/validation/kind_errors.hpp"
#include "kinfer/calibrate/validation/thresholds.hpp"
#include "kinfer/estimate/poses/redundancy.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/geometry/student.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/measurement/commanded_poses.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_freedom = 1000;  // of the t distribution, which is the normal one from there on

/// The fitted rows that the fit did not reject.
PoseSet inlier_rows(const Estimate& fit, const PoseSet& fitted_rows) {
  return select(fitted_rows, without_outliers(all_rows(fitted_rows), fit.outliers));
}

/// Noise of the kinds for which the instrument states none, by the residuals of the fit; zero of all others.
ExcessNoise unstated_noise(const Estimate& fit, const PoseSet& inliers, const Instrument& instrument) {
  const auto determined = std::ranges::count_if(fit.values, &ParameterEstimate::identifiable);
  ExcessNoise noise = noise_of_fit(fit.chain, fit.parameters, inliers, instrument, static_cast<double>(determined));
  for (const ResidualKind& kind : residual_kinds())
    if (kind.traits.sigma_of(instrument) > 0.0) noise.of[index(kind.kind)] = noise.of_pose[index(kind.kind)] = 0.0;
  return noise;
}

/// Covariance of the parameters if the instrument's noise were all that is wrong. That of the fit grows with the
/// residuals: with few rows a model that explains nothing is as good as expected by it.
MatrixXd covariance_at_noise(const Estimate& fit, const PoseSet& inliers, const Instrument& instrument,
                             const ExcessNoise& unstated) {
  const PoseSet& rows = inliers;
  const Weights weights = weights_of(rows, instrument, unstated);
  VectorXd residuals;
  MatrixXd jacobian;
  pose_residuals(fit.chain, fit.parameters, rows, weights)
      .evaluate(pack(fit.parameters, fit.chain), residuals, &jacobian);
  return invert_but_for_rounding(gram(jacobian));
}

/// Mean error of each row, of one kind of measurement [m]; NaN where it has none.
std::vector<double> error_of_rows(std::optional<MeasurementKind> kind, const Chain& chain, const PoseSet& fitted_rows,
                                  const PoseSet& rows) {
  std::vector<double> sum(rows.rows(), 0.0), count(rows.rows(), 0.0);
  const std::vector<double> errors =
      kind ? position_errors_of_fit(*kind, chain, fitted_rows, rows) : std::vector<double>{};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const int row = residual_kind(*kind).row(rows, i);
    sum[row] += errors[i], count[row] += 1.0;
  }
  for (std::size_t row = 0; row < sum.size(); ++row) sum[row] = count[row] > 0.0 ? sum[row] / count[row] : not_measured;
  return sum;
}

void append(std::vector<double>& to, const std::vector<double>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Of the angles that were measured: orientations, or tilts where there are none.
MeasurementKind angle_kind(const PoseSet& data) {
  return data.orientations.empty() && !data.tilts.empty() ? kind_of<TiltMeasurement> : kind_of<OrientationMeasurement>;
}

/// The kinds whose errors are those of the tool's position and orientation, in all rows alike.
struct JudgedKinds {
  std::optional<MeasurementKind> position;
  MeasurementKind angle;
};

/// The position is judged by what is held out: a kind that only fitted rows have would prove nothing.
JudgedKinds judged_kinds(const EvaluationInputs& evaluated) {
  std::vector<int> held_out;
  for (const Split& split : evaluated.plan.validation_splits)
    held_out.insert(held_out.end(), split.holdout.begin(), split.holdout.end());
  std::ranges::sort(held_out);
  return {primary_measurement_kind(select(evaluated.data, held_out)), angle_kind(evaluated.data)};
}

/// Errors of one chain, or of the corresponding chains of all validation fits.
struct ErrorLists {
  JudgedKinds kinds;
  std::vector<double> position{}, orientation{};

  void add(const Chain& chain, const PoseSet& fitted_rows, const PoseSet& rows) {
    if (kinds.position) append(position, position_errors_of_fit(*kinds.position, chain, fitted_rows, rows));
    append(orientation, errors_of_kind(kinds.angle, chain, rows));
  }
  void write_statistics(ChainFit& fit, ErrorStatistics TrainHoldout::*which) const {
    fit.position.*which = error_statistics(position);
    fit.orientation.*which = error_statistics(orientation);
  }
};

void fill_train(ChainFit& fit, const JudgedKinds& kinds, const Chain& chain, const PoseSet& fitted_rows,
                const PoseSet& rows) {
  ErrorLists errors{kinds};
  errors.add(chain, fitted_rows, rows);
  errors.write_statistics(fit, &TrainHoldout::train);
}

/// Statistics over the held-out rows without `skipped`.
void fill_held_out(Calibration& calibration, const EvaluationInputs& evaluated, const JudgedKinds& kinds,
                   const std::vector<int>& skipped, ErrorStatistics TrainHoldout::*which) {
  ErrorLists nominal{kinds}, before{kinds}, after{kinds};
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

void fill_rows(Calibration& calibration, const EvaluationInputs& evaluated, std::optional<MeasurementKind> kind) {
  const PoseSet fitted = select(evaluated.data, evaluated.plan.fitted);
  const std::vector<double> before = error_of_rows(kind, evaluated.frames_only, fitted, evaluated.data),
                            after = error_of_rows(kind, calibration.estimate.chain, fitted, evaluated.data);
  for (int row = 0; row < evaluated.data.rows(); ++row)
    calibration.rows.push_back({row, before[row], after[row], after[row], false});
  for (std::size_t i = 0; i < evaluated.fits.size(); ++i) {
    const Split& split = evaluated.plan.validation_splits[i];
    const PoseSet rows = select(evaluated.data, split.holdout), fitted_rows = select(evaluated.data, split.train);
    const std::vector<double> holdout_before = error_of_rows(kind, evaluated.fits[i].before, fitted_rows, rows),
                              holdout_after = error_of_rows(kind, evaluated.fits[i].after.chain, fitted_rows, rows);
    for (std::size_t k = 0; k < split.holdout.size(); ++k) {
      RowErrors& entry = calibration.rows[split.holdout[k]];
      entry.before = holdout_before[k];
      entry.after = holdout_after[k];
      entry.held_out = true;
    }
  }
}

/// Without those by which fixtures of unknown place are placed and nothing is left to judge: the only contact of a
/// socket is where that socket is, whatever the robot.
template <class M>
std::size_t redundant_measurements(const std::vector<M>& list) {
  if constexpr (RefersToFixture<M>) {
    constexpr auto& fixtures = std::get<index(fixture_kind(M::traits.fixture))>(fixture_lists);
    if constexpr (fixtures.prior == FixturePrior::none) {
      const std::size_t unknowns =
          fields_of(typename std::decay_t<decltype(Fixtures{}.*fixtures.list)>::value_type{}).size();
      std::map<int, std::size_t> of_fixture;
      for (const M& measurement : list) ++of_fixture[measurement.*M::fixture_index];
      return std::accumulate(of_fixture.begin(), of_fixture.end(), std::size_t{0}, [&](std::size_t sum, const auto& f) {
        return sum + (f.second * M::traits.rows > unknowns ? f.second : 0);
      });
    }
  }
  return list.size();
}

}  // namespace

std::optional<MeasurementKind> primary_measurement_kind(const PoseSet& data) {
  std::optional<MeasurementKind> enough, most;
  std::size_t most_count = 0;
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if (enough || !M::traits.observes.tool_position) return;
    const std::size_t count = redundant_measurements(list);
    if (count >= thresholds::min_judging_measurements) enough = kind_of<M>;
    if (count > most_count) most = kind_of<M>, most_count = count;
  });
  return enough ? enough : most;
}

std::vector<double> position_errors_of_fit(MeasurementKind kind, const Chain& chain, const PoseSet& fitted_rows,
                                           const PoseSet& evaluated) {
  return position_errors(kind, with_unfitted_fixtures(chain, fitted_rows, evaluated), evaluated);
}

void fill_error_statistics(Calibration& calibration, const EvaluationInputs& evaluated) {
  const std::vector<int> inliers = without_outliers(evaluated.plan.fitted, calibration.estimate.outliers);
  const PoseSet rows = select(evaluated.data, inliers), no_rows;
  const JudgedKinds kinds = judged_kinds(evaluated);
  fill_train(calibration.nominal, kinds, evaluated.nominal, no_rows, rows);
  fill_train(calibration.before, kinds, evaluated.frames_only, rows, rows);
  fill_train(calibration.after, kinds, calibration.estimate.chain, rows, rows);
  fill_held_out(calibration, evaluated, kinds, evaluated.gross_errors, &TrainHoldout::holdout);
  fill_held_out(calibration, evaluated, kinds, {}, &TrainHoldout::holdout_all_rows);
  fill_rows(calibration, evaluated, kinds.position);
  calibration.measured = kinds.position.value_or(kinds.angle);
}

std::optional<double> chance_of_improvement(const std::vector<RowErrors>& rows, const std::vector<int>& skipped,
                                            const PoseSet& data) {
  std::vector<int> judged;
  for (const RowErrors& row : rows)
    if (row.held_out && !std::isnan(row.before) && !std::isnan(row.after)) judged.push_back(row.row);
  judged = without(std::move(judged), skipped);
  const std::vector<int> pose_of_row = commanded_poses(data);
  std::map<int, std::size_t> place;
  for (const int row : judged) place.try_emplace(pose_of_row[static_cast<std::size_t>(row)], place.size());
  const std::size_t poses = place.size();
  if (poses < 2) return std::nullopt;
  std::vector<double> gain(poses, 0.0), count(poses, 0.0);
  for (const int judged_row : judged) {
    const RowErrors& row = rows[static_cast<std::size_t>(judged_row)];
    const std::size_t pose = place.at(pose_of_row[static_cast<std::size_t>(judged_row)]);
    gain[pose] += row.before - row.after, count[pose] += 1.0;
  }
  for (std::size_t pose = 0; pose < poses; ++pose) gain[pose] /= count[pose];
  const double sd = standard_deviation(gain) / std::sqrt(static_cast<double>(poses));
  if (sd <= 0.0) return mean(gain) > 0.0 ? 0.0 : 1.0;
  return student_upper_tail(mean(gain) / sd, static_cast<int>(std::min<std::size_t>(poses - 1, most_freedom)));
}

std::optional<ExpectedErrors> expected_holdout_errors(const EvaluationInputs& evaluated) {
  const auto primary = judged_kinds(evaluated).position;
  if (!evaluated.instrument || !primary) return std::nullopt;
  const ResidualKind& kind = residual_kind(*primary);
  if (!evaluated.instrument->states_lengths() && kind.traits.sigma_of(*evaluated.instrument) <= 0.0)
    return std::nullopt;
  double squares = 0.0, squares_by_noise = 0.0, count = 0.0;
  for (std::size_t i = 0; i < evaluated.fits.size(); ++i) {
    const Estimate& fit = evaluated.fits[i].after;
    const PoseSet rows =
        select(evaluated.data, without(evaluated.plan.validation_splits[i].holdout, evaluated.gross_errors));
    const PoseSet fitted_rows = select(evaluated.data, evaluated.plan.validation_splits[i].train);
    const Chain chain = with_unfitted_fixtures(fit.chain, fitted_rows, rows);
    const PoseSet inliers = inlier_rows(fit, fitted_rows);
    const ExcessNoise unstated = unstated_noise(fit, inliers, *evaluated.instrument);
    const MatrixXd by_noise = covariance_at_noise(fit, inliers, *evaluated.instrument, unstated);
    const Weights weights = weights_of(rows, evaluated.instrument, unstated);
    const EvaluatedPoses at = evaluate_poses(chain, fit.parameters, rows, Derivative::yes);
    const FixtureColumns columns = fixture_columns(chain, fit.parameters);
    const ResidualContext scene{chain, rows, at, columns};
    VectorXd residual = VectorXd::Zero(3);
    MatrixXd jacobian = MatrixXd::Zero(3, fit.parameters.free_count());
    for (std::size_t k = 0; k < kind.count(rows); ++k) {
      BlockRows out{residual, &jacobian, 0};
      kind.write(scene, k, out);
      const double metres = kind.metres(scene, k), noise = weights.of(*primary)[k].head(kind.size).squaredNorm();
      const auto of_fit = [&](const MatrixXd& covariance) {
        return propagated_covariance(jacobian.topRows(kind.size), covariance).trace();
      };
      // A fixture of which every fitted row was rejected is not known; its rows tell nothing.
      constexpr double unknown_fixture = 1e4;  // [m²]
      const double by_fit = of_fit(covariance_of_predictions(fit));
      if (!(metres * metres * by_fit < unknown_fixture)) continue;
      squares += metres * metres * (noise + by_fit);
      squares_by_noise += metres * metres * (noise + of_fit(by_noise));
      count += 1.0;
    }
  }
  if (count == 0.0) return std::nullopt;
  return ExpectedErrors{std::sqrt(squares / count), std::sqrt(squares_by_noise / count)};
}

}  // namespace kinfer::calibrate
