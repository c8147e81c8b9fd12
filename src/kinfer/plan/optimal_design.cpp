// SPDX-License-Identifier: Apache-2.0
#include "kinfer/plan/optimal_design.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "kinfer/base/expect.hpp"
#include "kinfer/base/parallel.hpp"
#include "kinfer/linalg/block_products.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"
#include "kinfer/linalg/small_cholesky.hpp"
#include "kinfer/plan/thresholds.hpp"

namespace kinfer::plan {
namespace {

auto rows_of(const DesignProblem& problem, int candidate) {
  return problem.rows.middleRows(static_cast<Eigen::Index>(candidate) * problem.block, problem.block);
}

MatrixXd updated_information(const DesignProblem& problem, MatrixXd information, int candidate, double sign) {
  information += sign * gram(rows_of(problem, candidate));
  return information;
}

double sum_of_logs(const MatrixXd& cholesky_factor) {
  return cholesky_factor.diagonal().array().log().sum();
}

/// W with gain(candidate) = tr((I + G Σ Gᵀ)⁻¹ G Σ W Σ Gᵀ): the derivative of the criterion by the covariance.
MatrixXd sensitivity(const DesignProblem& problem, Criterion criterion, const MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  if (criterion == Criterion::a) return MatrixXd::Identity(n, n);
  if (criterion == Criterion::e)
    return product(product(covariance, covariance), covariance);  // tr Σ⁴: largest eigenvalue dominates
  VectorXd weight = VectorXd::Ones(problem.targets.rows() / 3);
  if (criterion == Criterion::worst) {
    const VectorXd variance = tool_variances(problem, covariance);
    weight = (variance / variance.maxCoeff()).array().pow(thresholds::worst_power - 1);
  }
  MatrixXd weighted = problem.targets;
  for (Eigen::Index t = 0; t < weight.size(); ++t) weighted.middleRows<3>(3 * t) *= weight[t];
  return transposed_times(problem.targets, weighted) / static_cast<double>(weight.size());
}

/// Gain of the criterion by adding each candidate, sign = 1, or loss by removing it, −1. D: log det(I ± G Σ Gᵀ).
VectorXd gains(const DesignProblem& problem, Criterion criterion, const MatrixXd& covariance, double sign) {
  const MatrixXd seen = product(problem.rows, covariance);
  MatrixXd felt;
  if (criterion != Criterion::d) felt = product(seen, sensitivity(problem, criterion, covariance));
  const Eigen::Index block = problem.block;
  VectorXd gain(problem.candidates());
  MatrixXd factor(block, block), inverse_factor(block, block), inverse(block, block), effect(block, block);
  for (Eigen::Index k = 0; k < gain.size(); ++k) {
    const auto seen_here = seen.middleRows(block * k, block);
    factor.setIdentity();
    add_product(seen_here, problem.rows.middleRows(block * k, block), sign, factor);
    if (!factorise_small(factor)) {  // the other rows leave a direction undetermined: neither added nor removed
      gain[k] = -sign * std::numeric_limits<double>::infinity();
    } else if (criterion == Criterion::d) {
      gain[k] = sign * 2.0 * sum_of_logs(factor);
    } else {
      inverse_factor.setIdentity(), inverse.setZero(), effect.setZero();
      solve_right(factor, inverse_factor);
      add_product(inverse_factor, inverse_factor, 1.0, inverse);
      add_product(felt.middleRows(block * k, block), seen_here, 1.0, effect);
      gain[k] = inverse.cwiseProduct(effect).sum();
    }
  }
  return gain;
}

/// Gain by adding one pose; `weight` is the sensitivity, empty for D.
double gain_of(const MatrixXd& rows, const MatrixXd& covariance, const MatrixXd& weight) {
  const MatrixXd seen = product(rows, covariance);
  MatrixXd spread = times_transposed(seen, rows);
  spread.diagonal().array() += 1.0;
  if (weight.size() == 0) {
    const auto factor = cholesky(spread);
    return factor ? 2.0 * sum_of_logs(*factor) : 0.0;
  }
  const auto inverse = invert_spd(spread);
  return inverse ? inverse->cwiseProduct(propagated_covariance(seen, weight)).sum() : 0.0;
}

bool allowed(const DesignProblem& problem, const std::vector<int>& chosen, int candidate) {
  return std::none_of(chosen.begin(), chosen.end(), [&](int other) {
    return other == candidate || (problem.too_close && problem.too_close(other, candidate));
  });
}

/// The best candidate to add to the chosen ones; −1: none may be added.
int best_addition(const DesignProblem& problem, Criterion criterion, const MatrixXd& information,
                  const std::vector<int>& chosen) {
  const auto covariance = invert_spd(information);
  if (!covariance) return -1;
  const VectorXd gain = gains(problem, criterion, *covariance, 1.0);
  std::vector<int> order(gain.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return gain[a] > gain[b]; });
  for (const int candidate : order)
    if (allowed(problem, chosen, candidate)) return candidate;
  return -1;
}

std::vector<int> random_design(const DesignProblem& problem, int count, Rng rng) {
  std::vector<int> chosen;
  const auto candidates = static_cast<std::uint64_t>(problem.candidates());
  for (int tries = 0; tries < 100 * count && static_cast<int>(chosen.size()) < count; ++tries) {
    const auto candidate = static_cast<int>(rng.index(candidates));
    if (allowed(problem, chosen, candidate)) chosen.push_back(candidate);
  }
  return chosen;
}

struct Design {
  std::vector<int> chosen;
  double objective = std::numeric_limits<double>::infinity();
};

/// Replaces each chosen candidate in turn by the best one, until a whole round changes nothing.
Design exchange(const DesignProblem& problem, Criterion criterion, std::vector<int> chosen) {
  MatrixXd now = information(problem, chosen);
  double best = objective(problem, criterion, now);
  for (int round = 0; round < thresholds::exchange_rounds; ++round) {
    bool changed = false;
    for (std::size_t place = 0; place < chosen.size(); ++place) {
      const int old = chosen[place];
      std::vector<int> others = chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
      const MatrixXd without = updated_information(problem, now, old, -1.0);
      const int better = best_addition(problem, criterion, without, others);
      if (better < 0 || better == old) continue;
      const MatrixXd next = updated_information(problem, without, better, 1.0);
      const double value = objective(problem, criterion, next);
      if (!(value < best - 1e-9 * std::abs(best))) continue;
      chosen[place] = better, now = next, best = value, changed = true;
    }
    if (!changed) break;
  }
  return {chosen, best};
}

/// Position in `chosen` of the least informative candidate.
std::size_t find_least_informative(const DesignProblem& problem, Criterion criterion, const MatrixXd& information,
                                   const std::vector<int>& chosen) {
  const auto covariance = invert_spd(information);
  const VectorXd loss =
      covariance ? gains(problem, criterion, *covariance, -1.0) : VectorXd::Zero(problem.candidates());
  return static_cast<std::size_t>(
      std::min_element(chosen.begin(), chosen.end(), [&](int a, int b) { return loss[a] < loss[b]; }) - chosen.begin());
}

}  // namespace

MatrixXd information(const DesignProblem& problem, const std::vector<int>& chosen) {
  const Eigen::Index n = problem.rows.cols();
  MatrixXd sum = MatrixXd::Identity(n, n);
  if (problem.prior_information.size() > 0) sum += problem.prior_information;
  for (const int candidate : chosen) sum = updated_information(problem, std::move(sum), candidate, 1.0);
  return sum;
}

VectorXd tool_variances(const DesignProblem& problem, const MatrixXd& covariance) {
  const MatrixXd spread = product(problem.targets, covariance);
  const VectorXd per_axis = spread.cwiseProduct(problem.targets).rowwise().sum();
  return per_axis.reshaped(3, per_axis.size() / 3).colwise().sum().transpose();
}

double objective(const DesignProblem& problem, Criterion criterion, const MatrixXd& information) {
  const auto factor = cholesky(information);
  if (!factor) return std::numeric_limits<double>::infinity();
  if (criterion == Criterion::d) return -2.0 * sum_of_logs(*factor);
  if (criterion == Criterion::e) return 1.0 / symmetric_eigen(information).values[0];
  const auto covariance = invert_spd(information);
  if (criterion == Criterion::a) return covariance->trace();
  const VectorXd variance = tool_variances(problem, *covariance);
  if (criterion == Criterion::tool) return variance.mean();
  const double largest = variance.maxCoeff();
  return largest *
         std::pow((variance / largest).array().pow(thresholds::worst_power).mean(), 1.0 / thresholds::worst_power);
}

std::vector<int> greedy_design(const DesignProblem& problem, Criterion criterion, int count) {
  std::vector<int> chosen;
  MatrixXd now = information(problem, {});
  for (int i = 0; i < count; ++i) {
    const int next = best_addition(problem, criterion, now, chosen);
    if (next < 0) break;
    chosen.push_back(next);
    now = updated_information(problem, std::move(now), next, 1.0);
  }
  return chosen;
}

std::vector<int> best_design(const DesignProblem& problem, Criterion criterion, int count, int starts, int threads,
                             Rng rng) {
  KINFER_EXPECT(problem.block == 3 || problem.block == 6, "blocks of {}", problem.block);
  std::vector<Design> designs(static_cast<std::size_t>(starts) + 1);
  parallel_for(designs.size(), threads, [&](std::size_t i) {
    designs[i] =
        exchange(problem, criterion,
                 i == 0 ? greedy_design(problem, criterion, count) : random_design(problem, count, rng.stream(i)));
  });
  const auto better = [](const Design& a, const Design& b) {
    return a.chosen.size() != b.chosen.size() ? a.chosen.size() > b.chosen.size() : a.objective < b.objective;
  };
  return std::min_element(designs.begin(), designs.end(), better)->chosen;
}

MatrixXd refined_design(const DesignProblem& problem, Criterion criterion, MatrixXd poses, const JacobianRows& rows_of,
                        const PoseProposer& propose, const std::function<bool(const MatrixXd&, Eigen::Index)>& allowed,
                        Rng rng) {
  MatrixXd now = information(problem, {});
  for (Eigen::Index i = 0; i < poses.cols(); ++i) {
    const MatrixXd rows = rows_of(poses.col(i));
    now += gram(rows);
  }
  for (int round = 0; round < thresholds::refinement_rounds; ++round) {
    double improvement = 0.0;
    for (Eigen::Index i = 0; i < poses.cols(); ++i) {
      Rng draws = rng.stream(round).stream(static_cast<std::uint64_t>(i));
      const MatrixXd old = rows_of(poses.col(i));
      const MatrixXd without = now - gram(old);
      const auto covariance = invert_spd(without);
      if (!covariance) continue;
      const MatrixXd weight = criterion == Criterion::d ? MatrixXd() : sensitivity(problem, criterion, *covariance);
      double best = gain_of(old, *covariance, weight);
      const double before = best;
      for (int k = 0; k < thresholds::refinement_proposals; ++k) {
        const VectorXd kept = poses.col(i), pose = propose(kept, draws);
        if (pose.size() == 0) continue;
        const MatrixXd rows = rows_of(pose);
        const double gain = gain_of(rows, *covariance, weight);
        if (!(gain > best)) continue;
        poses.col(i) = pose;
        if (allowed(poses, i)) {
          best = gain;
        } else {
          poses.col(i) = kept;
        }
      }
      const MatrixXd rows = rows_of(poses.col(i));
      now = without + gram(rows);
      improvement += (best - before) / before;
    }
    if (improvement < thresholds::refinement_gain) break;
  }
  return poses;
}

std::vector<int> find_redundant(const DesignProblem& problem, Criterion criterion, double rise) {
  std::vector<int> kept(problem.candidates()), removed;
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = static_cast<int>(i);
  MatrixXd now = information(problem, kept);
  const double with_all = objective(problem, criterion, now);
  const double limit = criterion == Criterion::d ? with_all + static_cast<double>(now.rows()) * std::log1p(rise)
                                                 : (1.0 + rise) * with_all;
  while (kept.size() > 1) {
    const std::size_t least = find_least_informative(problem, criterion, now, kept);
    now = updated_information(problem, std::move(now), kept[least], -1.0);
    if (!(objective(problem, criterion, now) <= limit)) break;
    removed.push_back(kept[least]);
    kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(least));
  }
  std::sort(removed.begin(), removed.end());
  return removed;
}

}  // namespace kinfer::plan
