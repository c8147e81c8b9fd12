// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/noise_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/functions/chain_series.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/calibrate/validation/validation_plan.hpp"
#include "kinfer/estimate/poses/redundancy.hpp"
#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

/// Number of parameters that the data determine.
double effective_parameters(const Estimate& fit) {
  const std::vector<const Parameter*> free = fit.parameters.free();
  double sum = 0.0;
  for (std::size_t k = 0; k < free.size(); ++k) {
    const double left = fit.values[k].sd / free[k]->prior_sd;
    sum += std::max(0.0, 1.0 - left * left);
  }
  return sum;
}

/// How many residuals each block counts: those of one quantity that was measured again at the same pose count once.
std::vector<double> residuals_of_blocks(const PoseSet& data) {
  const auto repeated = repeated_measurements(data);
  std::vector<double> counts;
  for (const Block& block : blocks_of(data)) {
    const RepeatedMeasurements& groups = repeated[index(block.kind)];
    counts.push_back(block.size / (groups.empty() ? 1.0 : groups.size_of(static_cast<std::size_t>(block.index))));
  }
  return counts;
}

double log_evidence_of_all(const LinearisedTerms& terms) {
  return log_evidence(terms, VectorXd::Ones(terms.image.size()));
}

/// Normal equations of some rows, in units of each parameter's scale.
struct Squares {
  MatrixXd information;
  VectorXd gradient;
  double cost = 0.0;
};

Squares squares_of(const MatrixXd& jacobian, const VectorXd& residuals) {
  return {gram(jacobian), jacobian.transpose() * residuals, residuals.squaredNorm()};
}

/// Whether the noise that is stated is all that measurements have which geometry does not explain.
enum class ModelError { none, possible };

/// The measurements about a chain, those of uncertain noise and all others with the priors.
class LinearisedMeasurements {
 public:
  LinearisedMeasurements(const TermModel& all, const PoseSet& rows, const std::optional<Instrument>& instrument,
                         const Weights& weights, ModelError error)
      : set_(restricted_to_data(all.parameters, rows)), free_(set_.free()), value_(pack(set_, all.chain)) {
    VectorXd residuals;
    MatrixXd jacobian;
    pose_residuals(all.chain, set_, rows, weights).evaluate(value_, residuals, &jacobian);
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k)
      jacobian.col(k) *= std::isfinite(free_[k]->prior_sd) ? free_[k]->prior_sd : free_[k]->scale;
    const RowsByNoise by_noise = rows_by_noise(rows, instrument, weights, error, residuals.size());
    uncertain_rows_ = by_noise.uncertain_count, lowest_level_ = by_noise.lowest_level;
    uncertain_ = squares_of(jacobian(by_noise.uncertain, Eigen::all), residuals(by_noise.uncertain));
    others_ = squares_of(jacobian(by_noise.others, Eigen::all), residuals(by_noise.others));
    for (const CandidateParameter& candidate : all.terms) {
      const auto at = std::ranges::find_if(free_, [&](const Parameter* p) { return p->at == candidate.parameter.at; });
      KINFER_EXPECT(at != free_.end(), "{} is no parameter of this model", candidate.parameter.name);
      terms_.push_back(static_cast<int>(at - free_.begin()));
    }
  }

  double uncertain_rows() const { return uncertain_rows_; }
  double lowest_level() const { return lowest_level_; }

  /// `level`: of the uncertain noise, in units of the weights'.
  TermsAtNoise at(double level) const {
    const double weight = 1.0 / (level * level);
    const MatrixXd normal = weight * uncertain_.information + others_.information,
                   covariance = invert_but_for_rounding(normal);
    const VectorXd image = -(weight * uncertain_.gradient + others_.gradient), step = covariance * image;
    TermsAtNoise result{terms_of(covariance, step)};
    result.log_likelihood = -uncertain_rows_ * std::log(level) -
                            0.5 * (weight * uncertain_.cost + others_.cost - image.dot(step)) -
                            cholesky_but_for_rounding(normal).diagonal().array().log().sum() -
                            log_evidence_of_all(result.terms) + std::log(level / (1.0 + level * level));
    return result;
  }

 private:
  struct RowsByNoise {
    std::vector<Eigen::Index> uncertain, others;
    double uncertain_count = 0.0;
    double lowest_level = thresholds::lowest_noise_part;  ///< that of the noise that is stated
  };
  static RowsByNoise rows_by_noise(const PoseSet& data, const std::optional<Instrument>& instrument,
                                   const Weights& weights, ModelError error, Eigen::Index rows) {
    const Weights stated = weights_of(data, instrument.value_or(Instrument{}));
    RowsByNoise result;
    Eigen::Index row = 0;
    const std::vector<double> counts = residuals_of_blocks(data);
    auto count = counts.begin();
    for (const Block& block : blocks_of(data)) {
      const double noise = stated.of(block.kind)[block.index].maxCoeff(),
                   part = noise / weights.of(block.kind)[block.index].maxCoeff();
      const bool is_stated = noise > noise_free_sd, is_all = error == ModelError::none || !(part < 1.0);
      if (!(is_stated && is_all)) result.uncertain_count += *count;
      ++count;
      if (is_stated && !is_all) result.lowest_level = std::max(result.lowest_level, part);
      for (int k = 0; k < block.size; ++k) (is_stated && is_all ? result.others : result.uncertain).push_back(row++);
    }
    for (; row < rows; ++row) result.others.push_back(row);
    return result;
  }

  LinearisedTerms terms_of(const MatrixXd& covariance, const VectorXd& step) const {
    VectorXd offset(static_cast<Eigen::Index>(terms_.size()));
    for (Eigen::Index i = 0; i < offset.size(); ++i) {
      const Parameter& parameter = *free_[terms_[i]];
      offset[i] = (value_[terms_[i]] - parameter.nominal) / parameter.prior_sd + step[terms_[i]];
    }
    return without_own_prior(covariance(terms_, terms_), offset);
  }

  ParameterSet set_;
  std::vector<const Parameter*> free_;
  VectorXd value_;
  std::vector<int> terms_;
  double uncertain_rows_ = 0.0;  ///< repeated ones once
  double lowest_level_ = 0.0;
  Squares uncertain_, others_;
};

/// Up and down from the level of geometry until neither all terms nor none are possible any more.
std::vector<TermsAtNoise> possible_levels(const LinearisedMeasurements& measurements, double step) {
  std::vector<TermsAtNoise> levels{measurements.at(1.0)};
  const double farthest = -std::log(thresholds::lowest_noise_part), lowest = -std::log(measurements.lowest_level());
  double none = levels[0].log_likelihood, all = none + log_evidence_of_all(levels[0].terms);
  for (const double direction : {1.0, -1.0})
    for (double log_level = step; log_level < (direction > 0.0 ? farthest : lowest); log_level += step) {
      levels.push_back(measurements.at(std::exp(direction * log_level)));
      const double without = levels.back().log_likelihood, with = without + log_evidence_of_all(levels.back().terms);
      none = std::max(none, without), all = std::max(all, with);
      if (without < none - thresholds::impossible_noise && with < all - thresholds::impossible_noise) break;
    }
  return levels;
}

}  // namespace

std::vector<TermsAtNoise> linearise_at_noise_levels(const Estimate& geometry, const TermModel& all, const PoseSet& rows,
                                                    const std::optional<Instrument>& instrument) {
  const PoseSet inliers = select(rows, without_outliers(all_rows(rows), geometry.outliers));
  const std::vector<double> counts = residuals_of_blocks(inliers);
  const double residuals = std::accumulate(counts.begin(), counts.end(), 0.0);
  if (residuals - static_cast<double>(all.parameters.free_count()) > thresholds::most_uncertain_redundancy ||
      has_series(all.chain) || !all.chain.field.empty())
    return {};
  const double effective = effective_parameters(geometry);
  const Weights weights = weights_of(inliers, instrument,
                                     noise_of_fit(geometry.chain, geometry.parameters, inliers, instrument, effective));
  const LinearisedMeasurements measurements(
      all, inliers, instrument, weights,
      residuals > static_cast<double>(all.terms.size()) ? ModelError::none : ModelError::possible);
  if (measurements.uncertain_rows() == 0.0) return {};
  const double level_sd = 1.0 / std::sqrt(2.0 * std::max(1.0, residuals - effective));
  return possible_levels(measurements, thresholds::noise_level_step * level_sd);
}

}  // namespace kinfer::calibrate
