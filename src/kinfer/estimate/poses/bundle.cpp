// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/bundle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinfer/base/expect.hpp"
#include "kinfer/estimate/identifiability.hpp"
#include "kinfer/estimate/poses/noise_level.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/estimate/poses/redundancy.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/poses/tool_derivatives.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/normal_equations.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer {
namespace {

/// State of the fit between its stages.
struct State {
  Chain chain;
  std::vector<bool> inlier;  ///< one per block
  ExcessNoise excess;
  LeastSquaresOutcome outcome;  ///< of the last run, on the inlier blocks
  SearchSummary search;
};

/// Squared singular values of the measurement Jacobian, rows in units of the noise and columns in units of the prior.
VectorXd scaled_information_spectrum(const NormalEquations& normal, const ParameterSet& set) {
  VectorXd scale(set.free_count());
  Eigen::Index k = 0;
  for (const Parameter* p : set.free()) scale[k++] = std::isfinite(p->prior_sd) ? p->prior_sd : p->scale;
  MatrixXd information = normal.matrix - prior_information(set).triangularView<Eigen::Lower>().toDenseMatrix();
  information = scale.asDiagonal() * information * scale.asDiagonal();
  return symmetric_eigen(information).values.cwiseMax(0.0);
}

/// Σ s²/(1+s²): effective number of parameters that the data determine.
double effective_parameters(const NormalEquations& normal, const ParameterSet& set) {
  const VectorXd s2 = scaled_information_spectrum(normal, set);
  return (s2.array() / (1.0 + s2.array())).sum();
}

constexpr double coarse_tolerance = 1e-7;    // relative decrease of the cost
constexpr double warm_start_damping = 1e-9;  // initial damping when the start is the optimum of nearly the same problem
constexpr double robust_loss_scale = 2.0;    // [sigma] per row
constexpr std::size_t rows_a_change = 1000;  // of one that may still become an inlier or outlier in the next round
constexpr double final_tolerance = 1e-6;     // of the cost of one row: accurate to a thousandth of each sd

class Fit {
 public:
  Fit(const Chain& start, const ParameterSet& set, const PoseSet& data, const std::optional<Instrument>& instrument,
      const BundleOptions& options, const Observer& observer)
      : set_(set),
        data_(data),
        instrument_(instrument),
        options_(options),
        observer_(observer),
        no_columns_(fixture_columns(start, {})) {
    state_.chain = start;
    blocks_ = blocks_of(data);
    state_.inlier.assign(blocks_.size(), true);
    state_.search.method = SearchMethod::levenberg_marquardt;
    state_.excess = excess_noise(scene(data), instrument, equal_redundancy(data, options.absorbed));
  }

  Estimate run() {
    if (options_.outliers == Outliers::detect) {
      if (options_.initial_guess == InitialGuess::rough) fit_robustly();
      update_inliers();
    }
    fit_inliers();
    return summary();
  }

 private:
  /// `tolerance`: relative decrease of the cost at which a run ends; rounds that only settle the noise level can be
  /// coarse.
  void minimise(Loss loss, double tolerance) {
    const PoseSet kept = keep_measurements(data_, state_.inlier);
    const Weights weights = weights_of(kept, instrument_, state_.excess);
    SearchSummary& search = state_.search;
    LeastSquaresOptions options;
    options.max_iterations = options_.max_iterations;
    options.cost_tolerance = tolerance;
    options.final_step = FinalStep::skipped;
    if (search.iterations > 0 || options_.initial_guess == InitialGuess::near_optimum)
      options.initial_damping = warm_start_damping;
    const Chain nominal = state_.chain;
    state_.outcome =
        least_squares(pose_normal_problem(nominal, set_, kept, weights, {loss, robust_loss_scale}, options_.threads),
                      pack(set_, nominal), options, observer_);
    state_.chain = unpack(set_, nominal, state_.outcome.x);
    poses_.reset();
    search.iterations += state_.outcome.iterations;
    search.evaluations += state_.outcome.evaluations;
    search.stop = state_.outcome.stop;
    search.cost = state_.outcome.cost;
    search.best.insert(search.best.end(), state_.outcome.history.begin(), state_.outcome.history.end());
  }

  /// True when the noise level has converged.
  bool update_noise_level() {
    const PoseSet kept = keep_measurements(data_, state_.inlier);
    const ExcessNoise now = excess_noise(scene(kept), instrument_, redundancy(kept));
    const auto settled = [](double before, double after) { return std::abs(after - before) <= 0.02 * before; };
    bool done = true;
    for (std::size_t k = 0; k < now.of.size(); ++k) done &= settled(state_.excess.of[k], now.of[k]);
    state_.excess = now;
    return done;
  }

  RedundancyOfKinds redundancy(const PoseSet& kept) const {
    return redundancy_of_kinds(
        state_.chain, set_, kept, weights_of(kept, instrument_, state_.excess),
        {.by_parameters = effective_parameters(state_.outcome.normal, set_), .by_functions = options_.absorbed},
        options_.threads);
  }

  /// Alternates between noise level and parameters, under a redescending (Cauchy) loss.
  void fit_robustly() {
    constexpr int rounds = 8;
    for (int i = 0; i < rounds; ++i) {
      minimise(Loss::cauchy, coarse_tolerance);
      if (update_noise_level()) break;
    }
  }

  /// Plain least squares on the inliers, until noise level and inliers are consistent with the fit.
  void fit_inliers() {
    constexpr int rounds = 5;
    for (int i = 0; i < rounds; ++i) {
      minimise(Loss::none, coarse_tolerance);
      const bool settled = update_noise_level();
      const std::size_t changed = options_.outliers == Outliers::keep_all ? 0 : update_inliers();
      if (!settled || changed > tolerated_changes()) continue;
      if (options_.detail == Detail::numbers_only) return;
      break;
    }
    minimise(Loss::none, final_tolerance / static_cast<double>(std::max<std::size_t>(1, blocks_.size())));
  }

  /// Mahalanobis distance [sigma] of each block. An orientation is conditioned on the point of its row only where that
  /// point is an inlier.
  VectorXd mahalanobis_distances() const {
    Weights weights = weights_of_single(data_, instrument_, state_.excess);
    if (weights.couplings.empty()) return mahalanobis_distances(weights);
    const std::vector<PoseCoupling> couplings = std::exchange(weights.couplings, {});
    const VectorXd alone = mahalanobis_distances(weights);  // points are the first blocks
    for (const PoseCoupling& c : couplings)
      if (alone[c.point] <= inlier_limits()[2]) weights.couplings.push_back(c);
    return mahalanobis_distances(weights);
  }

  VectorXd mahalanobis_distances(const Weights& weights) const {
    const VectorXd r = weighted_residuals(scene(data_), weights);
    VectorXd distance(static_cast<Eigen::Index>(blocks_.size()));
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < blocks_.size(); row += blocks_[i++].size)
      distance[static_cast<Eigen::Index>(i)] = r.segment(row, blocks_[i].size).norm();
    return distance;
  }

  /// The present chain at the rows of `data`: all measurements, or those that were kept of them.
  ResidualContext scene(const PoseSet& data) const {
    if (!poses_) poses_ = evaluate_poses(state_.chain, {}, data_, Derivative::no, options_.threads);
    return {state_.chain, data, *poses_, no_columns_};
  }

  /// Largest Mahalanobis distance [sigma] of an inlier block of 1, 2, 3 rows.
  std::array<double, 3> inlier_limits() const {
    const double quantile = 1.0 - options_.false_alarms / std::max<double>(1.0, static_cast<double>(blocks_.size()));
    std::array<double, 3> inlier_limits;
    for (int size = 1; size <= 3; ++size) inlier_limits[size - 1] = std::sqrt(chi_squared_quantile(quantile, size));
    return inlier_limits;
  }

  /// Among thousands of rows a few lie so near the limit that they go in and out for many rounds.
  std::size_t tolerated_changes() const {
    return options_.detail == Detail::numbers_only ? blocks_.size() / rows_a_change : 0;
  }

  /// How many blocks became inliers or outliers.
  std::size_t update_inliers() {
    const VectorXd distance = mahalanobis_distances();
    const std::array<double, 3> limit = inlier_limits();
    std::size_t changed = 0;
    for (std::size_t i = 0; i < state_.inlier.size(); ++i) {
      const bool is_inlier = distance[static_cast<Eigen::Index>(i)] <= limit[blocks_[i].size - 1];
      if (is_inlier != state_.inlier[i]) ++changed;
      state_.inlier[i] = is_inlier;
    }
    return changed;
  }

  Estimate summary() const {
    Estimate estimate;
    estimate.chain = state_.chain;
    estimate.parameters = set_;
    estimate.search = state_.search;
    describe_noise(estimate);
    describe_parameters(estimate);
    describe_outliers(estimate);
    if (options_.detail == Detail::numbers_only) return estimate;
    estimate.identifiability = identifiability(inlier_jacobian(), set_);
    estimate.negative_log_evidence = negative_log_evidence();
    estimate.predicted_error = predicted_rms(estimate);
    return estimate;
  }

  /// Weighted Jacobian of the inlier measurements, without prior rows.
  MatrixXd inlier_jacobian() const {
    const PoseSet kept = keep_measurements(data_, state_.inlier);
    const Weights weights = weights_of(kept, instrument_, state_.excess);
    VectorXd r;
    MatrixXd jacobian;
    pose_residuals(state_.chain, set_, kept, weights, options_.threads).evaluate(state_.outcome.x, r, &jacobian);
    return jacobian.topRows(jacobian.rows() - set_.free_count());
  }

  void describe_noise(Estimate& estimate) const {
    const PoseSet kept = keep_measurements(data_, state_.inlier);
    const Weights weights = weights_of_single(kept, instrument_, state_.excess);
    const std::vector<double> ranges = metres_of_primary_kind(kept);
    estimate.sigma = typical_sd(weights, [](const MeasurementTraits& t) { return t.observes.tool_position; }) *
                     (ranges.empty() ? 1.0 : rms(ranges));
    estimate.sigma_pose = state_.excess.of_pose[index(kind_of<PointMeasurement>)] * (kept.points.empty() ? 0.0 : 1.0);
    estimate.sigma_angle =
        typical_sd(weights, [](const MeasurementTraits& t) { return t.unit == ResidualUnit::angle; });
    if (instrument_) estimate.chi2_per_n = normalised_chi2(kept);
  }

  /// −2 log of the marginal likelihood by Laplace's approximation: misfit, noise level over all rows including
  /// outliers, and the Occam factor of the parameters.
  double negative_log_evidence() const {
    const PoseSet kept = keep_measurements(data_, state_.inlier);
    const Weights weights = weights_of(kept, instrument_, state_.excess);
    double sum = evidence_of_repeats(scene(kept), instrument_, state_.excess) + state_.outcome.cost +
                 scaled_information_spectrum(state_.outcome.normal, set_).array().log1p().sum();
    for (const ResidualKind& kind : residual_kinds()) {
      const double sd = typical_sd(weights, kind);
      if (sd > 0.0) sum += 2.0 * kind.size * static_cast<double>(kind.count(data_)) * std::log(sd);
    }
    for (const PoseCoupling& coupling : weights.couplings) sum += coupling.log_determinant();
    return sum;
  }

  /// Metres at the tool point of one unit of each residual of the first kind that observes it; empty: all 1.
  std::vector<double> metres_of_primary_kind(const PoseSet& data) const {
    for (const ResidualKind& kind : residual_kinds()) {
      if (!kind.traits.observes.tool_position || kind.count(data) == 0) continue;
      if (!kind.model.metres) return {};
      const ResidualContext at = scene(data);
      std::vector<double> metres(kind.count(data));
      for (std::size_t i = 0; i < metres.size(); ++i) metres[i] = kind.metres(at, i);
      return metres;
    }
    return {};
  }

  /// A kind counts only where the instrument specifies its accuracy, with its own redundancy; known distances between
  /// sockets with the mean one.
  std::optional<double> normalised_chi2(PoseSet kept) const {
    VectorXd distances(static_cast<Eigen::Index>(state_.chain.fixtures.socket_distances.size()));
    write_socket_distances(state_.chain, no_columns_, distances, nullptr, 0);
    const RedundancyOfKinds part_left = redundancy(kept);
    for_each_list(kept, [&]<class M>(std::vector<M>& list) {
      if (M::traits.sigma_of(*instrument_) <= 0.0) list.clear();
    });
    if (!has_measurements(kept)) return std::nullopt;
    const VectorXd r = weighted_residuals(scene(kept), weights_of(kept, *instrument_));
    double left = 0.0;
    for (const ResidualKind& kind : residual_kinds())
      left += part_left[index(kind.kind)] * kind.size * static_cast<double>(kind.count(kept));
    left *= 1.0 + static_cast<double>(distances.size()) / static_cast<double>(r.size());
    return (r.squaredNorm() + distances.squaredNorm()) / std::max(1.0, left);
  }

  void describe_parameters(Estimate& estimate) const {
    const std::vector<const Parameter*> free = set_.free();
    estimate.covariance = covariance_of_normal_matrix(state_.outcome.normal.matrix);
    for (Eigen::Index k = 0; k < estimate.covariance.rows(); ++k) {
      const Parameter& parameter = *free[k];
      const double sd = std::sqrt(std::max(0.0, estimate.covariance(k, k)));
      estimate.values.push_back({parameter.name, parameter.quantity, parameter.nominal, state_.outcome.x[k], sd,
                                 sd * sd < 0.5 * parameter.prior_sd * parameter.prior_sd});
    }
  }

  void describe_outliers(Estimate& estimate) const {
    if (std::find(state_.inlier.begin(), state_.inlier.end(), false) == state_.inlier.end()) return;
    const VectorXd distance = mahalanobis_distances();
    const ResidualContext all = scene(data_);
    VectorXd residual = VectorXd::Zero(3);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (state_.inlier[i]) continue;
      const Block& block = blocks_[i];
      const ResidualKind& kind = residual_kind(block.kind);
      BlockRows out{residual, nullptr, 0};
      kind.write(all, static_cast<std::size_t>(block.index), out);
      const int line = data_.line.empty() ? 0 : data_.line[block.row];
      const double sigmas = distance[static_cast<Eigen::Index>(i)];
      const OutlierReason reason{block.kind, residual.head(kind.size).norm(), sigmas};
      estimate.outliers.push_back({.row = block.row, .line = line, .reasons = {reason}, .sigmas = sigmas});
    }
    std::stable_sort(estimate.outliers.begin(), estimate.outliers.end(),
                     [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
    merge_rows(estimate.outliers);
  }

  /// A row with several outlier measurements is listed once.
  static void merge_rows(std::vector<Outlier>& outliers) {
    std::vector<Outlier> merged;
    for (const Outlier& outlier : outliers) {
      if (merged.empty() || merged.back().row != outlier.row) {
        merged.push_back(outlier);
        continue;
      }
      merged.back().reasons.insert(merged.back().reasons.end(), outlier.reasons.begin(), outlier.reasons.end());
      merged.back().sigmas = std::max(merged.back().sigmas, outlier.sigmas);
    }
    outliers = std::move(merged);
  }

  double predicted_rms(const Estimate& estimate) const {
    double sum = 0.0;
    for (const Twists& twists : evaluate_poses(estimate.chain, set_, data_, Derivative::yes, options_.threads).twists)
      sum += propagated_covariance(twists.topRows<3>(), estimate.covariance).trace();
    return data_.rows() > 0 ? std::sqrt(sum / static_cast<double>(data_.rows())) : 0.0;
  }

  const ParameterSet& set_;
  const PoseSet& data_;
  const std::optional<Instrument>& instrument_;
  const BundleOptions& options_;
  const Observer& observer_;
  const FixtureColumns no_columns_;  ///< of residuals without derivatives
  std::vector<Block> blocks_;
  State state_;
  mutable std::optional<EvaluatedPoses> poses_;  ///< of the present chain, once they were asked for
};

}  // namespace

Estimate fit_bundle(const Chain& start, const ParameterSet& set, const PoseSet& data,
                    const std::optional<Instrument>& instrument, const BundleOptions& options,
                    const Observer& observer) {
  KINFER_EXPECT(has_measurements(data), "nothing measured");
  return Fit(start, set, data, instrument, options, observer).run();
}

Mat3 predicted_covariance(const Estimate& estimate, ConstVectorRef q) {
  const PoseEvaluator evaluator(estimate.chain, estimate.parameters);
  Twists twists;
  evaluator.pose_and_derivative(q, {}, twists);
  return propagated_covariance(twists.topRows<3>(), estimate.covariance);
}

VectorXd predicted_errors(const Estimate& estimate, ConstMatrixRef joints) {
  const MatrixXd jacobian = tool_derivatives(estimate.chain, estimate.parameters, joints).jacobian;
  const VectorXd variance = (jacobian * estimate.covariance).cwiseProduct(jacobian).rowwise().sum();
  return variance.reshaped(3, joints.cols()).colwise().sum().cwiseSqrt().transpose();
}

}  // namespace kinfer
