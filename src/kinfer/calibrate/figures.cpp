#include "kinfer/calibrate/figures.hpp"

#include <cmath>
#include <limits>

#include "kinfer/calibrate/surroundings.hpp"

namespace kinfer {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// Mean headline error of each row [m]; NaN where it has none.
std::vector<double> error_of_rows(const std::vector<double>& errors, const PoseSet& rows) {
  std::vector<double> sum(rows.rows(), 0.0), count(rows.rows(), 0.0);
  const auto kind = headline_kind(rows);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const int row = residual_kind(*kind).row(rows, i);
    sum[row] += errors[i], count[row] += 1.0;
  }
  for (std::size_t row = 0; row < sum.size(); ++row) sum[row] = count[row] > 0.0 ? sum[row] / count[row] : not_measured;
  return sum;
}

std::vector<double> error_of_rows(const Chain& chain, const PoseSet& seen, const PoseSet& rows) {
  return error_of_rows(headline_errors(chain, seen, rows), rows);
}

void append(std::vector<double>& to, const std::vector<double>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Errors of one chain, or of its counterparts in all proofs.
struct Gathered {
  std::vector<double> position, orientation;

  void add(const Chain& chain, const PoseSet& seen, const PoseSet& rows) {
    append(position, headline_errors(chain, seen, rows));
    append(orientation, orientation_errors(chain, rows));
  }
  void put(ChainFit& fit, ErrorStatistics TrainHoldout::*which) const {
    fit.position.*which = error_statistics(position);
    fit.orientation.*which = error_statistics(orientation);
  }
};

void fill_train(ChainFit& fit, const Chain& chain, const PoseSet& seen, const PoseSet& rows) {
  Gathered errors;
  errors.add(chain, seen, rows);
  errors.put(fit, &TrainHoldout::train);
}

/// Over the held-out rows without `skipped`.
void fill_held_out(Calibration& calibration, const Judged& judged, const std::vector<int>& skipped,
                   ErrorStatistics TrainHoldout::*which) {
  Gathered nominal, before, after;
  const PoseSet nothing_seen;
  for (std::size_t i = 0; i < judged.proofs.size(); ++i) {
    const Split& split = judged.plan.proofs[i];
    const PoseSet rows = select(judged.data, without(split.holdout, skipped));
    const PoseSet seen = select(judged.data, split.train);
    nominal.add(judged.nominal, nothing_seen, rows);
    before.add(judged.proofs[i].before, seen, rows);
    after.add(judged.proofs[i].after.chain, seen, rows);
  }
  nominal.put(calibration.nominal, which);
  before.put(calibration.before, which);
  after.put(calibration.after, which);
}

void fill_rows(Calibration& calibration, const Judged& judged) {
  const PoseSet fitted = select(judged.data, judged.plan.fitted);
  const std::vector<double> before = error_of_rows(judged.frames_only, fitted, judged.data),
                            after = error_of_rows(calibration.estimate.chain, fitted, judged.data);
  for (int row = 0; row < judged.data.rows(); ++row)
    calibration.rows.push_back({row, before[row], after[row], after[row], false});
  for (std::size_t i = 0; i < judged.proofs.size(); ++i) {
    const Split& split = judged.plan.proofs[i];
    const PoseSet rows = select(judged.data, split.holdout), seen = select(judged.data, split.train);
    const std::vector<double> unseen_before = error_of_rows(judged.proofs[i].before, seen, rows),
                              unseen_after = error_of_rows(judged.proofs[i].after.chain, seen, rows);
    for (std::size_t k = 0; k < split.holdout.size(); ++k) {
      RowErrors& entry = calibration.rows[split.holdout[k]];
      entry.before = unseen_before[k];
      entry.after = unseen_after[k];
      entry.held_out = true;
    }
  }
}

}  // namespace

std::optional<MeasurementKind> headline_kind(const PoseSet& data) {
  for (const MeasurementKind kind : {MeasurementKind::point, MeasurementKind::contact, MeasurementKind::distance,
                                     MeasurementKind::pair, MeasurementKind::plane})
    if (residual_kind(kind).count(data) > 0) return kind;
  return std::nullopt;
}

std::string_view headline_word(std::optional<MeasurementKind> kind) {
  if (!kind) return "orientation";
  switch (*kind) {
    case MeasurementKind::contact:
      return "ball in socket";
    case MeasurementKind::distance:
      return "distance";
    case MeasurementKind::pair:
      return "ball-bar length";
    case MeasurementKind::plane:
      return "distance from the plane";
    default:
      return "position";
  }
}

std::vector<double> headline_errors(const Chain& chain, const PoseSet& seen, const PoseSet& judged) {
  const auto kind = headline_kind(judged);
  if (!kind) return {};
  return errors_of_kind(*kind, with_unseen_surroundings(chain, seen, judged), judged);
}

void fill_figures(Calibration& calibration, const Judged& judged) {
  const std::vector<int> believed = without(judged.plan.fitted, calibration.estimate.outliers);
  const PoseSet rows = select(judged.data, believed), nothing_seen;
  fill_train(calibration.nominal, judged.nominal, nothing_seen, rows);
  fill_train(calibration.before, judged.frames_only, rows, rows);
  fill_train(calibration.after, calibration.estimate.chain, rows, rows);
  fill_held_out(calibration, judged, judged.wrong, &TrainHoldout::holdout);
  fill_held_out(calibration, judged, {}, &TrainHoldout::holdout_all_rows);
  fill_rows(calibration, judged);
  calibration.measured = headline_word(headline_kind(judged.data));
}

std::optional<double> expected_error(const Judged& judged) {
  const auto headline = headline_kind(judged.data);
  if (!judged.instrument || !headline) return std::nullopt;
  const ResidualKind& kind = residual_kind(*headline);
  double squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < judged.proofs.size(); ++i) {
    const Estimate& fit = judged.proofs[i].after;
    const PoseSet rows = select(judged.data, without(judged.plan.proofs[i].holdout, judged.wrong));
    const Chain chain = with_unseen_surroundings(fit.chain, select(judged.data, judged.plan.proofs[i].train), rows);
    const Weights promised = weights_of(rows, *judged.instrument);
    const EvaluatedPoses at = evaluate_poses(chain, fit.parameters, rows, Derivative::yes);
    const ColumnsOfSurroundings columns = columns_of_surroundings(chain, fit.parameters);
    const Scene scene{chain, rows, at, columns};
    VectorXd residual = VectorXd::Zero(3);
    MatrixXd jacobian = MatrixXd::Zero(3, fit.parameters.free_count());
    for (std::size_t k = 0; k < kind.count(rows); ++k) {
      BlockRows out{residual, &jacobian, 0};
      kind.write(scene, k, out);
      const auto block = jacobian.topRows(kind.size);
      squares += promised.of(*headline)[k].head(kind.size).squaredNorm() +
                 (block * fit.covariance * block.transpose()).trace();
      count += 1.0;
    }
  }
  return count > 0.0 ? std::optional(std::sqrt(squares / count)) : std::nullopt;
}

}  // namespace kinfer
