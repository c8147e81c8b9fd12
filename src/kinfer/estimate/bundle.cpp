#include "kinfer/estimate/bundle.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/estimate/identifiability.hpp"
#include "kinfer/estimate/noise_level.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

/// All that the fit passes from step to step.
struct State {
  Chain chain;
  std::vector<bool> believed;  ///< one a block
  ExcessNoise excess;
  LeastSquaresOutcome outcome;  ///< of the last run, on the believed blocks
  Search search;
};

PoseSet only_believed(const PoseSet& data, const std::vector<bool>& believed) {
  PoseSet kept = data;
  kept.points.clear();
  kept.orientations.clear();
  for (std::size_t i = 0; i < data.points.size(); ++i)
    if (believed[i]) kept.points.push_back(data.points[i]);
  for (std::size_t i = 0; i < data.orientations.size(); ++i)
    if (believed[data.points.size() + i]) kept.orientations.push_back(data.orientations[i]);
  return kept;
}

/// Σ s²/(1+s²) over the singular values in units of noise and prior: how many parameters the data determine.
double effective_parameters(const LeastSquaresOutcome& outcome, const ParameterSet& set) {
  const MatrixXd data_rows = outcome.jacobian.topRows(outcome.jacobian.rows() - set.free_count());
  const VectorXd s2 = identifiability(data_rows, set).singular_values.cwiseAbs2();
  return (s2.array() / (1.0 + s2.array())).sum();
}

class Fit {
 public:
  Fit(const Chain& start, const ParameterSet& set, const PoseSet& data, const std::optional<Instrument>& instrument,
      const BundleOptions& options, const Observer& observer)
      : set_(set), data_(data), instrument_(instrument), options_(options), observer_(observer) {
    state_.chain = start;
    state_.believed.assign(data.points.size() + data.orientations.size(), true);
    state_.search.method = "lm";
    state_.excess = excess_noise(start, data, instrument, 0.0);
  }

  Estimate run() {
    if (options_.outliers == Outliers::find) fit_robustly();
    fit_believed();
    return summary();
  }

 private:
  void minimise(Loss loss) {
    const PoseSet kept = only_believed(data_, state_.believed);
    const Weights weights = weights_of(kept, instrument_, state_.excess);
    LeastSquaresOptions options;
    options.max_iterations = options_.max_iterations;
    options.loss = loss;
    options.loss_scale = 2.0;
    const Chain nominal = state_.chain;
    state_.outcome =
        least_squares(pose_residuals(nominal, set_, kept, weights), pack(set_, nominal), options, observer_);
    state_.chain = unpack(set_, nominal, state_.outcome.x);
    Search& search = state_.search;
    search.iterations += state_.outcome.iterations;
    search.evaluations += state_.outcome.evaluations;
    search.stop = state_.outcome.stop;
    search.cost = state_.outcome.cost;
    search.best.insert(search.best.end(), state_.outcome.history.begin(), state_.outcome.history.end());
  }

  /// True when the noise level has settled.
  bool update_noise_level() {
    const PoseSet kept = only_believed(data_, state_.believed);
    const ExcessNoise now = excess_noise(state_.chain, kept, instrument_, effective_parameters(state_.outcome, set_));
    const auto settled = [](double before, double after) { return std::abs(after - before) <= 0.02 * before; };
    const bool done =
        settled(state_.excess.position, now.position) && settled(state_.excess.orientation, now.orientation);
    state_.excess = now;
    return done;
  }

  /// Noise level and parameters in turn, under a loss that wrong rows cannot pull.
  void fit_robustly() {
    constexpr int rounds = 8;
    for (int i = 0; i < rounds; ++i) {
      minimise(Loss::cauchy);
      if (update_noise_level()) break;
    }
    update_beliefs();
  }

  /// Plain least squares on the believed rows, until level and beliefs agree with the fit.
  void fit_believed() {
    constexpr int rounds = 5;
    for (int i = 0; i < rounds; ++i) {
      minimise(Loss::none);
      const bool settled = update_noise_level();
      const bool same = options_.outliers == Outliers::believe_all || !update_beliefs();
      if (settled && same) break;
    }
    minimise(Loss::none);
  }

  VectorXd block_distances() const {  // [sigma], one a block
    const Weights weights = weights_of(data_, instrument_, state_.excess);
    const ParameterSet nothing;
    VectorXd r;
    pose_residuals(state_.chain, nothing, data_, weights).evaluate(VectorXd(0), r, nullptr);
    return r.reshaped(3, r.size() / 3).colwise().norm().transpose();
  }

  double limit() const {
    const double blocks = std::max<double>(1.0, static_cast<double>(state_.believed.size()));
    return std::sqrt(chi_squared_quantile(1.0 - options_.false_alarms / blocks, 3));
  }

  /// True when some belief changed.
  bool update_beliefs() {
    const VectorXd distance = block_distances();
    bool changed = false;
    for (std::size_t i = 0; i < state_.believed.size(); ++i) {
      const bool believe = distance[i] <= limit();
      changed |= believe != state_.believed[i];
      state_.believed[i] = believe;
    }
    return changed;
  }

  Estimate summary() const {
    Estimate estimate;
    estimate.chain = state_.chain;
    estimate.parameters = set_;
    estimate.search = state_.search;
    const MatrixXd data_rows = state_.outcome.jacobian.topRows(state_.outcome.jacobian.rows() - set_.free_count());
    estimate.identifiability = identifiability(data_rows, set_);
    describe_noise(estimate);
    describe_parameters(estimate);
    describe_outliers(estimate);
    estimate.predicted_error = predicted_rms(estimate);
    return estimate;
  }

  void describe_noise(Estimate& estimate) const {
    const PoseSet kept = only_believed(data_, state_.believed);
    const Weights weights = weights_of(kept, instrument_, state_.excess);
    std::vector<double> sd;
    for (const Vec3& v : weights.point_sd) sd.push_back(v.norm() / std::sqrt(3.0));
    estimate.sigma = rms(sd);
    estimate.sigma_angle = rms(weights.orientation_sd);
    if (!instrument_) return;
    const Weights promised = weights_of(kept, *instrument_);
    const ParameterSet nothing;
    VectorXd r;
    pose_residuals(state_.chain, nothing, kept, promised).evaluate(VectorXd(0), r, nullptr);
    const double redundancy = std::max(1.0, static_cast<double>(r.size()) - effective_parameters(state_.outcome, set_));
    estimate.chi2_per_n = r.squaredNorm() / redundancy;
  }

  void describe_parameters(Estimate& estimate) const {
    const std::vector<const Parameter*> free = set_.free();
    const MatrixXd& jacobian = state_.outcome.jacobian;
    // Scaled to unit diagonal: the inverse is then as accurate as the problem allows.
    const VectorXd scale = jacobian.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    const MatrixXd scaled = jacobian * scale.asDiagonal();
    const auto inverse = inverse_positive(scaled.transpose() * scaled);
    const Eigen::Index n = scale.size();
    estimate.covariance = inverse ? MatrixXd(scale.asDiagonal() * *inverse * scale.asDiagonal()) : MatrixXd::Zero(n, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Parameter& parameter = *free[k];
      const double sd = std::sqrt(std::max(0.0, estimate.covariance(k, k)));
      estimate.values.push_back({parameter.name, parameter.quantity, parameter.nominal, state_.outcome.x[k], sd,
                                 sd * sd < 0.5 * parameter.prior_sd * parameter.prior_sd});
    }
  }

  void describe_outliers(Estimate& estimate) const {
    const VectorXd distance = block_distances();
    const std::vector<double> off = point_errors(estimate.chain, data_),
                              turned = orientation_errors(estimate.chain, data_);
    const std::vector<Block> blocks = blocks_of(data_);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (state_.believed[i]) continue;
      const Block& block = blocks[i];
      const std::string what =
          block.kind == MeasurementKind::point
              ? fmt::format("the point lies {:.3f} mm from where the model has it", 1e3 * off[block.index])
              : fmt::format("the orientation is {:.3f} deg from what the model has", turned[block.index] / degree);
      const int line = data_.line.empty() ? 0 : data_.line[block.row];
      estimate.outliers.push_back({block.row, line, fmt::format("{} ({:.0f} sigma)", what, distance[i])});
    }
    std::stable_sort(estimate.outliers.begin(), estimate.outliers.end(),
                     [](const Outlier& a, const Outlier& b) { return a.row < b.row; });
  }

  double predicted_rms(const Estimate& estimate) const {
    double sum = 0.0;
    const PoseEvaluator evaluator(estimate.chain, set_);
    Twists twists;
    for (Eigen::Index row = 0; row < data_.rows(); ++row) {
      const Load load{.payload = data_.payload.empty() ? 0.0 : data_.payload[row]};
      evaluator.pose_and_derivative(data_.joints.col(row), load, twists);
      sum += (twists.topRows<3>() * estimate.covariance * twists.topRows<3>().transpose()).trace();
    }
    return data_.rows() > 0 ? std::sqrt(sum / static_cast<double>(data_.rows())) : 0.0;
  }

  const ParameterSet& set_;
  const PoseSet& data_;
  const std::optional<Instrument>& instrument_;
  const BundleOptions& options_;
  const Observer& observer_;
  State state_;
};

}  // namespace

Estimate fit_bundle(const Chain& start, const ParameterSet& set, const PoseSet& data,
                    const std::optional<Instrument>& instrument, const BundleOptions& options,
                    const Observer& observer) {
  KINFER_EXPECT(!data.points.empty() || !data.orientations.empty(), "nothing measured");
  return Fit(start, set, data, instrument, options, observer).run();
}

Mat3 predicted_covariance(const Estimate& estimate, ConstVectorRef q) {
  const PoseEvaluator evaluator(estimate.chain, estimate.parameters);
  Twists twists;
  evaluator.pose_and_derivative(q, {}, twists);
  return twists.topRows<3>() * estimate.covariance * twists.topRows<3>().transpose();
}

}  // namespace kinfer
