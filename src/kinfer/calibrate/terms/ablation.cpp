// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/ablation.hpp"

#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::calibrate {

Chain chain_with_scaled_priors(const Estimate& fit, std::span<const int> parameters, std::span<const double> scale) {
  const std::vector<const Parameter*> free = fit.parameters.free();
  const std::vector<int> own(parameters.begin(), parameters.end());
  VectorXd x(static_cast<Eigen::Index>(free.size())), offset(static_cast<Eigen::Index>(own.size()));
  for (std::size_t k = 0; k < free.size(); ++k) x[static_cast<Eigen::Index>(k)] = fit.values[k].value;
  // In units of the prior standard deviations, for an accurate inverse.
  VectorXd unit(offset.size()), more(offset.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    offset[i] = x[own[k]] - free[own[k]]->nominal;
    unit[i] = free[own[k]]->prior_sd;
    more[i] = scale[k] * scale[k] / (1.0 - scale[k] * scale[k]);
  }
  MatrixXd block = unit.cwiseInverse().asDiagonal() * fit.covariance(own, own) * unit.cwiseInverse().asDiagonal();
  block.diagonal() += more;
  const auto inverse = invert_spd(block);
  KINFER_EXPECT(inverse, "parameters with priors have a positive definite covariance");
  const VectorXd pull = unit.cwiseInverse().cwiseProduct(*inverse * unit.cwiseInverse().cwiseProduct(offset));
  x -= fit.covariance(Eigen::all, own) * pull;
  for (std::size_t k = 0; k < own.size(); ++k)
    if (scale[k] == 0.0) x[own[k]] = free[own[k]]->nominal;
  return unpack(fit.parameters, fit.chain, x);
}

Chain chain_without(const Estimate& fit, std::span<const int> removed) {
  return chain_with_scaled_priors(fit, removed, std::vector<double>(removed.size(), 0.0));
}

HoldoutErrors errors_with_scaled_terms(const HoldoutErrors& fits, const std::vector<CandidateParameter>& terms,
                                       const std::function<double(Term)>& scale, const PoseSet& rows,
                                       const std::vector<Split>& splits, int threads) {
  std::vector<CandidateParameter> changed;
  std::vector<double> by;
  for (const CandidateParameter& term : terms)
    if (const double s = scale(term.term); s < 1.0) changed.push_back(term), by.push_back(s);
  if (changed.empty()) return {{}, fits.errors, fits.row};
  std::vector<Chain> chains(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    chains[i] = chain_with_scaled_priors(fits.split_fits[i], free_indices(fits.split_fits[i], changed), by);
  });
  return evaluate_holdout(chains, rows, splits, threads);
}

double displacement(const Chain& chain, const std::vector<CandidateParameter>& terms, const PoseSet& rows) {
  Chain without = chain;
  for (const CandidateParameter& c : terms) set_value_at(without, c.parameter.at, c.parameter.nominal);
  const std::vector<Pose> with = evaluate_poses(chain, {}, rows, Derivative::no).pose,
                          plain = evaluate_poses(without, {}, rows, Derivative::no).pose;
  double sum = 0.0;
  for (std::size_t i = 0; i < with.size(); ++i) sum += (with[i].position - plain[i].position).squaredNorm();
  return std::sqrt(sum / static_cast<double>(with.size()));
}

}  // namespace kinfer::calibrate
