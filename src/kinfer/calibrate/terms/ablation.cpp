// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/terms/ablation.hpp"

#include <cmath>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/functions/chain_series.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer::calibrate {

Chain chain_without(const Estimate& fit, std::span<const int> removed) {
  const std::vector<const Parameter*> free = fit.parameters.free();
  const std::vector<int> own(removed.begin(), removed.end());
  VectorXd fitted(static_cast<Eigen::Index>(free.size())), offset(static_cast<Eigen::Index>(own.size()));
  for (std::size_t k = 0; k < free.size(); ++k) fitted[static_cast<Eigen::Index>(k)] = fit.values[k].value;
  // Scaled to unit prior variance before the inversion, for accuracy.
  VectorXd scale(offset.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    offset[static_cast<Eigen::Index>(k)] = fitted[own[k]] - free[own[k]]->nominal;
    scale[static_cast<Eigen::Index>(k)] = free[own[k]]->prior_sd;
  }
  const MatrixXd block = fit.covariance(own, own);
  const MatrixXd inverse =
      invert_but_for_rounding(scale.cwiseInverse().asDiagonal() * block * scale.cwiseInverse().asDiagonal());
  const VectorXd pull = scale.cwiseInverse().cwiseProduct(inverse * scale.cwiseInverse().cwiseProduct(offset));
  VectorXd x = fitted - fit.covariance(Eigen::all, own) * pull;
  for (const int k : own) x[k] = free[k]->nominal;
  const Chain without = unpack(fit.parameters, fit.chain, x);
  return fit.series_response.size() > 0 ? with_series_moved(without, fit.series_response * (x - fitted)) : without;
}

HoldoutErrors errors_without(const HoldoutErrors& fits, const std::vector<CandidateParameter>& terms,
                             const std::function<bool(Term)>& remove, const PoseSet& rows,
                             const std::vector<Split>& splits, int threads) {
  std::vector<CandidateParameter> removed;
  for (const CandidateParameter& term : terms)
    if (remove(term.term)) removed.push_back(term);
  if (removed.empty()) return {{}, fits.errors, fits.row, fits.pose};
  std::vector<Chain> chains(splits.size());
  parallel_for(splits.size(), threads, [&](std::size_t i) {
    chains[i] = chain_without(fits.split_fits[i], free_indices(fits.split_fits[i], removed));
  });
  return evaluate_holdout(chains, rows, splits, threads);
}

double rms_distance(const Chain& a, const Chain& b, const PoseSet& rows) {
  const std::vector<Pose> of_a = evaluate_poses(a, {}, rows, Derivative::no).pose,
                          of_b = evaluate_poses(b, {}, rows, Derivative::no).pose;
  double sum = 0.0;
  for (std::size_t i = 0; i < of_a.size(); ++i) sum += (of_a[i].position - of_b[i].position).squaredNorm();
  return std::sqrt(sum / static_cast<double>(of_a.size()));
}

double displacement(const Chain& chain, const std::vector<CandidateParameter>& terms, const PoseSet& rows) {
  Chain without = chain;
  for (const CandidateParameter& c : terms) set_value_at(without, c.parameter.at, c.parameter.nominal);
  return rms_distance(chain, without, rows);
}

}  // namespace kinfer::calibrate
