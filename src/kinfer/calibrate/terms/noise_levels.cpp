// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/noise_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/expect.hpp"
#include "kinfer/calibrate/functions/chain_series.hpp"
#include "kinfer/calibrate/parameters/parameter_sets.hpp"
#include "kinfer/calibrate/terms/thresholds.hpp"
#include "kinfer/calibrate/validation/validation_plan.hpp"
#include "kinfer/estimate/poses/redundancy.hpp"
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

/// The measurements about a chain, those of unstated noise and all others with the priors.
class LinearisedMeasurements {
 public:
  LinearisedMeasurements(const TermModel& all, const PoseSet& rows, const std::optional<Instrument>& instrument,
                         const Weights& weights)
      : set_(restricted_to_data(all.parameters, rows)), free_(set_.free()), value_(pack(set_, all.chain)) {
    VectorXd residuals;
    MatrixXd jacobian;
    pose_residuals(all.chain, set_, rows, weights).evaluate(value_, residuals, &jacobian);
    for (Eigen::Index k = 0; k < jacobian.cols(); ++k)
      jacobian.col(k) *= std::isfinite(free_[k]->prior_sd) ? free_[k]->prior_sd : free_[k]->scale;
    const RowsByNoise by_noise = rows_by_noise(rows, instrument, residuals.size());
    unstated_rows_ = by_noise.unstated.size();
    unstated_ = squares_of(jacobian(by_noise.unstated, Eigen::all), residuals(by_noise.unstated));
    others_ = squares_of(jacobian(by_noise.others, Eigen::all), residuals(by_noise.others));
    for (const CandidateParameter& candidate : all.terms) {
      const auto at = std::ranges::find_if(free_, [&](const Parameter* p) { return p->at == candidate.parameter.at; });
      KINFER_EXPECT(at != free_.end(), "{} is no parameter of this model", candidate.parameter.name);
      terms_.push_back(static_cast<int>(at - free_.begin()));
    }
  }

  std::size_t unstated_rows() const { return unstated_rows_; }

  /// `level`: of the unstated noise, in units of the weights'.
  TermsAtNoise at(double level) const {
    const double weight = 1.0 / (level * level);
    const MatrixXd normal = weight * unstated_.information + others_.information,
                   covariance = invert_but_for_rounding(normal);
    const VectorXd image = -(weight * unstated_.gradient + others_.gradient), step = covariance * image;
    TermsAtNoise result{terms_of(covariance, step)};
    result.log_likelihood = -static_cast<double>(unstated_rows_) * std::log(level) -
                            0.5 * (weight * unstated_.cost + others_.cost - image.dot(step)) -
                            cholesky_but_for_rounding(normal).diagonal().array().log().sum() -
                            log_evidence_of_all(result.terms) + std::log(level / (1.0 + level * level));
    return result;
  }

 private:
  struct RowsByNoise {
    std::vector<Eigen::Index> unstated, others;
  };
  static RowsByNoise rows_by_noise(const PoseSet& data, const std::optional<Instrument>& instrument,
                                   Eigen::Index rows) {
    const Weights stated = weights_of(data, instrument.value_or(Instrument{}));
    RowsByNoise result;
    Eigen::Index row = 0;
    for (const Block& block : blocks_of(data)) {
      const bool is_stated = stated.of(block.kind)[block.index].maxCoeff() > noise_free_sd;
      for (int k = 0; k < block.size; ++k) (is_stated ? result.others : result.unstated).push_back(row++);
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
  std::size_t unstated_rows_ = 0;
  Squares unstated_, others_;
};

/// Up and down from the level of geometry until neither all terms nor none are possible any more.
std::vector<TermsAtNoise> possible_levels(const LinearisedMeasurements& measurements, double step) {
  std::vector<TermsAtNoise> levels{measurements.at(1.0)};
  double none = levels[0].log_likelihood, all = none + log_evidence_of_all(levels[0].terms);
  for (const double direction : {1.0, -1.0})
    for (double log_level = step; log_level < -std::log(thresholds::lowest_noise_part); log_level += step) {
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
  double residuals = 0.0;
  for (const Block& block : blocks_of(inliers)) residuals += block.size;
  if (residuals - static_cast<double>(all.parameters.free_count()) > thresholds::most_uncertain_redundancy ||
      has_series(all.chain) || !all.chain.field.empty())
    return {};
  const double effective = effective_parameters(geometry);
  const Weights weights = weights_of(inliers, instrument,
                                     noise_of_fit(geometry.chain, geometry.parameters, inliers, instrument, effective));
  const LinearisedMeasurements measurements(all, inliers, instrument, weights);
  if (measurements.unstated_rows() == 0) return {};
  const double level_sd = 1.0 / std::sqrt(2.0 * std::max(1.0, residuals - effective));
  return possible_levels(measurements, thresholds::noise_level_step * level_sd);
}

}  // namespace kinfer::calibrate
