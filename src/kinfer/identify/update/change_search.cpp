// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/update/change_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/identify/update/thresholds.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

VectorXd prior_variance(const ChangeHypothesis& hypothesis, const ChangeScale& scale) {
  VectorXd variance = VectorXd::Constant(hypothesis.effect.cols(), scale.distance * scale.distance);
  variance.head(hypothesis.rotations).setConstant(scale.angle * scale.angle);
  return variance;
}

MatrixXd covariance_of_change(const ChangeHypothesis& hypothesis, const ChangeScale& scale) {
  const VectorXd sd = prior_variance(hypothesis, scale).cwiseSqrt();
  const MatrixXd scaled = hypothesis.effect * sd.asDiagonal();
  return times_transposed(scaled, scaled);
}

/// ln N(d; 0, C) but for a constant.
double log_density(ConstVectorRef d, ConstMatrixRef covariance) {
  const MatrixXd factor = cholesky_but_for_rounding(covariance);
  const VectorXd white = factor.triangularView<Eigen::Lower>().solve(VectorXd(d));
  return -0.5 * white.squaredNorm() - factor.diagonal().array().log().sum();
}

double log_mean_exp(const std::vector<double>& logs) {
  const double largest = *std::ranges::max_element(logs);
  double sum = 0.0;
  for (const double value : logs) sum += std::exp(value - largest);
  return largest + std::log(sum / static_cast<double>(logs.size()));
}

/// The chosen changes of a search, and what they leave.
class Search {
 public:
  Search(ConstVectorRef difference, ConstMatrixRef covariance, const std::vector<ChangeHypothesis>& hypotheses)
      : d_(difference), s_(covariance), hypotheses_(hypotheses) {}

  std::vector<ChosenChange> run() {
    for (std::size_t round = 0; round < 2 * hypotheses_.size(); ++round) {
      const ChosenChange best = best_addition();
      if (best.log_odds <= 0.0) break;
      chosen_.push_back(best);
      remove_doubtful();
    }
    for (ChosenChange& change : chosen_) change.log_odds = odds_of(change);
    std::ranges::sort(chosen_, std::ranges::greater{}, &ChosenChange::log_odds);
    return chosen_;
  }

 private:
  /// ln p(d | changes), averaged over the inflation of S.
  double evidence(const MatrixXd& of_changes) const {
    std::vector<double> logs;
    for (const double inflation : variance_inflations) logs.push_back(log_density(d_, inflation * s_ + of_changes));
    return log_mean_exp(logs);
  }

  MatrixXd covariance_without(std::size_t hypothesis) const {
    MatrixXd sum = MatrixXd::Zero(s_.rows(), s_.cols());
    for (const ChosenChange& change : chosen_)
      if (change.hypothesis != hypothesis) sum += covariance_of_change(hypotheses_[change.hypothesis], change.scale);
    return sum;
  }

  /// The change against its absence, with the sizes that explain it best.
  ChosenChange evaluate(std::size_t hypothesis) const {
    const ChangeHypothesis& h = hypotheses_[hypothesis];
    const MatrixXd others = covariance_without(hypothesis);
    ChosenChange result{.hypothesis = hypothesis};
    std::vector<double> logs;
    double best = -std::numeric_limits<double>::infinity();
    for (const double angle : change_angles)
      for (const double distance : change_distances) {
        logs.push_back(evidence(others + covariance_of_change(h, {angle, distance})));
        if (logs.back() > best) best = logs.back(), result.scale = {angle, distance};
      }
    const double prior = std::log(h.prior_probability / (1.0 - h.prior_probability));
    result.log_odds = log_mean_exp(logs) - evidence(others) + prior;
    return result;
  }

  double odds_of(const ChosenChange& change) const { return evaluate(change.hypothesis).log_odds; }

  ChosenChange best_addition() const {
    ChosenChange best{.log_odds = -std::numeric_limits<double>::infinity()};
    for (std::size_t h = 0; h < hypotheses_.size(); ++h) {
      if (std::ranges::find(chosen_, h, &ChosenChange::hypothesis) != chosen_.end()) continue;
      const ChosenChange change = evaluate(h);
      if (change.log_odds > best.log_odds) best = change;
    }
    return best;
  }

  /// A change that a later one explains better is dropped.
  void remove_doubtful() {
    const auto is_doubtful = [&](const ChosenChange& change) { return odds_of(change) < 0.0; };
    for (;;) {
      const auto doubtful = std::ranges::find_if(chosen_, is_doubtful);
      if (doubtful == chosen_.end()) return;
      chosen_.erase(doubtful);
    }
  }

  VectorXd d_;
  MatrixXd s_;
  const std::vector<ChangeHypothesis>& hypotheses_;
  std::vector<ChosenChange> chosen_;
};

}  // namespace

std::vector<ChosenChange> choose_changes(ConstVectorRef difference, ConstMatrixRef covariance,
                                         const std::vector<ChangeHypothesis>& hypotheses) {
  return Search(difference, covariance, hypotheses).run();
}

ChangeEstimate estimate_changes(ConstVectorRef difference, ConstMatrixRef covariance,
                                const std::vector<ChangeHypothesis>& hypotheses,
                                const std::vector<ChangeScale>& scales) {
  Index columns = 0;
  for (const ChangeHypothesis& h : hypotheses) columns += h.effect.cols();
  MatrixXd effect(difference.size(), columns);
  VectorXd variance(columns);
  Index at = 0;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const ChangeHypothesis& h = hypotheses[i];
    effect.middleCols(at, h.effect.cols()) = h.effect;
    variance.segment(at, h.effect.cols()) = prior_variance(h, scales[i]);
    at += h.effect.cols();
  }
  const MatrixXd weighted = product(invert_but_for_rounding(covariance), effect);
  MatrixXd posterior = transposed_times(effect, weighted);
  posterior.diagonal() += variance.cwiseInverse();
  const MatrixXd inverse = invert_but_for_rounding(posterior);
  return {inverse * (weighted.transpose() * difference), inverse};
}

double squared_distance(ConstVectorRef difference, ConstMatrixRef covariance) {
  const MatrixXd factor = cholesky_but_for_rounding(covariance);
  return VectorXd(factor.triangularView<Eigen::Lower>().solve(VectorXd(difference))).squaredNorm();
}

}  // namespace kinfer::identify
