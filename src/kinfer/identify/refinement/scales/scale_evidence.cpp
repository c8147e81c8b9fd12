// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/scales/scale_evidence.hpp"

#include <cmath>

#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

/// What the recording tells of g.
struct GroupEvidence {
  MatrixXd information;  ///< Λ
  VectorXd right;        ///< b
};

GroupEvidence group_evidence(const ScaleEstimate& estimate, ConstMatrixRef a) {
  const MatrixXd weighted = product(estimate.prior_information, a);
  return {transposed_times(a, weighted) - transposed_times(weighted, product(estimate.covariance, weighted)),
          weighted.transpose() * estimate.mean};
}

double log_odds(const SymmetricEigen& information, const VectorXd& right, double sd) {
  double twice = 0.0;
  for (Index i = 0; i < right.size(); ++i) {
    const double growth = 1.0 + sd * sd * std::max(0.0, information.values[i]);
    twice += sd * sd * right[i] * right[i] / growth - std::log(growth);
  }
  return 0.5 * twice;
}

/// The most likely sd up to `largest`, on a grid of a tenth of itself.
Widening most_likely(std::size_t candidate, const GroupEvidence& evidence, double largest) {
  constexpr double smallest = 1e-5, ratio = 1.1;
  const SymmetricEigen information = symmetric_eigen(evidence.information);
  const VectorXd right = information.vectors.transpose() * evidence.right;
  Widening best{.candidate = candidate};
  for (double sd = smallest; sd < largest; sd *= ratio)
    if (const double odds = log_odds(information, right, sd); odds > best.log_odds)
      best = {.candidate = candidate, .sd = sd, .log_odds = odds};
  return best;
}

/// The estimate under the prior covariance P + s² A A' (Woodbury's identity).
void widen(ScaleEstimate& estimate, ConstMatrixRef a, double sd) {
  const MatrixXd weighted = product(estimate.prior_information, a);
  const MatrixXd identity = MatrixXd::Identity(a.cols(), a.cols()) / (sd * sd), prior = transposed_times(a, weighted);
  const MatrixXd shift = product(estimate.covariance, weighted);
  const auto of_prior = invert_spd(identity + prior),
             of_estimate = invert_spd(identity + prior - transposed_times(weighted, shift));
  if (!of_prior || !of_estimate) return;
  estimate.mean += shift * (*of_estimate * (weighted.transpose() * estimate.mean));
  estimate.covariance += times_transposed(product(shift, *of_estimate), shift);
  estimate.prior_information -= times_transposed(product(weighted, *of_prior), weighted);
}

}  // namespace

std::vector<Widening> find_widenings(ScaleEstimate estimate, const std::vector<WideningCandidate>& candidates,
                                     double log_prior_odds) {
  std::vector<Widening> found;
  while (found.size() < candidates.size()) {
    Widening best;
    for (std::size_t c = 0; c < candidates.size(); ++c)
      if (const Widening now =
              most_likely(c, group_evidence(estimate, candidates[c].directions), candidates[c].largest_sd);
          now.log_odds > best.log_odds)
        best = now;
    if (best.log_odds + log_prior_odds < 0.0) break;
    widen(estimate, candidates[best.candidate].directions, best.sd);
    found.push_back(best);
  }
  return found;
}

}  // namespace kinfer::identify
