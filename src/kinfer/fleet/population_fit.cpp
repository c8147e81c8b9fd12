// SPDX-License-Identifier: Apache-2.0
#include "kinfer/fleet/population_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "kinfer/estimate/poses/parameter_information.hpp"
#include "kinfer/fleet/thresholds.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/linalg/decompositions.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::fleet {
namespace {

/// Of the population's parameters, in their order; `names`, `nominal` and `tolerance` are left empty.
using RobotLikelihood = ParameterInformation;

/// In tolerances from nominal.
struct Gaussian {
  VectorXd mean;
  MatrixXd covariance;
};

/// In tolerances from nominal of the population, where it has the parameter. Robots may have other data sheets:
/// u = s + S v, with u of the robot and v of the population, so Λ becomes S Λ S and h becomes S (h − Λ s).
ParameterInformation in_units_of(const PopulationPrior& population, ParameterInformation robot) {
  VectorXd shift = VectorXd::Zero(robot.vector.size()), scale = VectorXd::Ones(robot.vector.size());
  for (Eigen::Index i = 0; i < robot.vector.size(); ++i) {
    const auto found = std::ranges::find(population.names, robot.names[static_cast<std::size_t>(i)]);
    if (found == population.names.end()) continue;
    const Eigen::Index at = found - population.names.begin();
    shift[i] = (population.nominal[at] - robot.nominal[i]) / robot.tolerance[i];
    scale[i] = population.tolerance[at] / robot.tolerance[i];
  }
  robot.vector = scale.cwiseProduct(robot.vector - robot.information * shift);
  robot.information = scale.asDiagonal() * robot.information * scale.asDiagonal();
  return robot;
}

/// The likelihood without the parameters that are not listed, which are marginalised; zero for those that it lacks.
std::optional<RobotLikelihood> likelihood_of(const ParameterInformation& given, const PopulationPrior& population) {
  const auto n = static_cast<Eigen::Index>(population.names.size());
  const ParameterInformation robot = in_units_of(population, without_weak_directions(given));
  const auto own = static_cast<Eigen::Index>(robot.names.size());
  std::vector<Eigen::Index> to(robot.names.size(), -1);
  MatrixXd regular = robot.information;
  for (Eigen::Index i = 0; i < own; ++i) {
    const auto at = std::ranges::find(population.names, robot.names[static_cast<std::size_t>(i)]);
    if (at != population.names.end())
      to[static_cast<std::size_t>(i)] = at - population.names.begin();
    else
      regular(i, i) += 1.0;  // its own tolerance holds it while it is marginalised
  }
  std::vector<Eigen::Index> kept, left;
  for (Eigen::Index i = 0; i < own; ++i) (to[static_cast<std::size_t>(i)] < 0 ? left : kept).push_back(i);
  const auto part = [&](const std::vector<Eigen::Index>& rows, const std::vector<Eigen::Index>& columns) {
    MatrixXd block(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
    for (Eigen::Index r = 0; r < block.rows(); ++r)
      for (Eigen::Index c = 0; c < block.cols(); ++c)
        block(r, c) = regular(rows[static_cast<std::size_t>(r)], columns[static_cast<std::size_t>(c)]);
    return block;
  };
  const auto rows_of = [&](const std::vector<Eigen::Index>& rows) {
    VectorXd values(static_cast<Eigen::Index>(rows.size()));
    for (Eigen::Index r = 0; r < values.size(); ++r) values[r] = robot.vector[rows[static_cast<std::size_t>(r)]];
    return values;
  };
  MatrixXd marginal = part(kept, kept);
  VectorXd vector = rows_of(kept);
  if (!left.empty()) {
    const auto inverse = invert_spd(part(left, left));
    if (!inverse) return std::nullopt;
    const MatrixXd gain = product(part(kept, left), *inverse);
    vector -= gain * rows_of(left);
    marginal -= times_transposed(gain, part(kept, left));
  }
  RobotLikelihood result{.information = MatrixXd::Zero(n, n), .vector = VectorXd::Zero(n)};
  for (std::size_t r = 0; r < kept.size(); ++r) {
    const Eigen::Index row = to[static_cast<std::size_t>(kept[r])];
    result.vector[row] = vector[static_cast<Eigen::Index>(r)];
    for (std::size_t c = 0; c < kept.size(); ++c)
      result.information(row, to[static_cast<std::size_t>(kept[c])]) =
          marginal(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
  }
  const bool is_finite = result.information.allFinite() && result.vector.allFinite();
  return is_finite && result.information.trace() > 0.0 ? std::optional(result) : std::nullopt;
}

/// One robot seen from the population.
struct RobotPosterior {
  VectorXd mean;
  MatrixXd covariance;
  double distance = 0.0;  ///< squared, of its mean from the population's
};

std::optional<RobotPosterior> posterior_of(const RobotLikelihood& robot, const Gaussian& population,
                                           const MatrixXd& inverse_covariance) {
  auto covariance = invert_spd(robot.information + inverse_covariance);
  if (!covariance) return std::nullopt;
  const VectorXd step = *covariance * (robot.vector - robot.information * population.mean);
  return RobotPosterior{.mean = population.mean + step,
                        .covariance = std::move(*covariance),
                        .distance = step.dot(inverse_covariance * step)};
}

using Robots = std::vector<const RobotLikelihood*>;

/// How many further robots the prior knowledge counts for.
struct Shrinkage {
  double uncorrelated = 200.0;  ///< robots with the population's variances and no correlation
  double toleranced = 1.0;      ///< robots with the data sheet's variances
};

/// Expectation maximisation.
Gaussian fit_gaussian(const Robots& robots, Eigen::Index n, const Shrinkage& shrinkage) {
  constexpr int most_iterations = 40;
  constexpr double converged = 1e-3;  // tolerances; the standard deviations of the result are some tenths of one
  const double largest = chi_squared_quantile(thresholds::population_share, static_cast<double>(n));
  Gaussian now{VectorXd::Zero(n), MatrixXd::Identity(n, n)};
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const auto inverse = invert_spd(now.covariance);
    if (!inverse) break;
    std::vector<RobotPosterior> posteriors;
    std::vector<double> weights;
    VectorXd sum = VectorXd::Zero(n);
    double total = 0.0;
    for (const RobotLikelihood* robot : robots) {
      auto posterior = posterior_of(*robot, now, *inverse);
      if (!posterior) continue;
      // E[(x − mean)ᵀ Σ⁻¹ (x − mean)] is n for a robot of the population.
      const double expected = posterior->distance + (posterior->covariance * *inverse).trace();
      const double weight = std::min(1.0, largest / expected);
      sum += weight * posterior->mean;
      total += weight;
      weights.push_back(weight);
      posteriors.push_back(std::move(*posterior));
    }
    Gaussian next{sum / (total + thresholds::nominal_robots), MatrixXd::Zero(n, n)};
    MatrixXd scatter = MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < posteriors.size(); ++k) {
      const VectorXd off = posteriors[k].mean - next.mean;
      scatter += weights[k] * (posteriors[k].covariance + off * off.transpose());
    }
    const auto count = static_cast<double>(posteriors.size());
    const VectorXd variances = (scatter.diagonal().array() + shrinkage.toleranced) / (count + shrinkage.toleranced);
    next.covariance = scatter;
    next.covariance.diagonal() += shrinkage.uncorrelated * variances;
    next.covariance /= count + shrinkage.uncorrelated;
    const double change = std::max((next.mean - now.mean).cwiseAbs().maxCoeff(),
                                   (next.covariance - now.covariance).cwiseAbs().maxCoeff());
    now = std::move(next);
    if (change < converged) break;
  }
  return now;
}

/// The log likelihood of each robot under a population that was fitted to robots of the other folds, summed.
double held_out_likelihood(const Robots& robots, Eigen::Index n, const Shrinkage& shrinkage) {
  const std::size_t folds = std::min<std::size_t>(3, robots.size());
  double sum = 0.0;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    Robots fitted;
    for (std::size_t k = 0; k < robots.size(); ++k)
      if (k % folds != fold) fitted.push_back(robots[k]);
    const Gaussian population = fit_gaussian(fitted, n, shrinkage);
    for (std::size_t k = fold; k < robots.size(); k += folds)
      sum += log_marginal_likelihood(*robots[k], population.mean, population.covariance)
                 .value_or(-std::numeric_limits<double>::infinity());
  }
  return sum;
}

Shrinkage select_shrinkage(const Robots& all, Eigen::Index n) {
  // The choice is coarse, and 40 robots make it as well as more would.
  constexpr std::size_t enough = 40;
  Robots robots;
  for (std::size_t i = 0; i < std::min(enough, all.size()); ++i)
    robots.push_back(all[i * all.size() / std::min(enough, all.size())]);
  Shrinkage best;
  double most = -std::numeric_limits<double>::infinity();
  for (const double uncorrelated : {200.0, 12.0})
    for (const double toleranced : {1.0, 0.1, 5.0}) {
      const Shrinkage candidate{uncorrelated, toleranced};
      const double likelihood = held_out_likelihood(robots, n, candidate);
      if (likelihood > most) best = candidate, most = likelihood;
    }
  return best;
}

/// The parameters that at least half of the robots have, with nominal values and tolerances of the
/// first robot that has them.
PopulationPrior common_parameters(std::span<const ParameterInformation* const> robots) {
  std::map<std::string, int> counts;
  for (const ParameterInformation* robot : robots)
    for (const std::string& name : robot->names) ++counts[name];
  PopulationPrior population;
  std::vector<double> nominal, tolerance;
  for (const ParameterInformation* robot : robots)
    for (std::size_t i = 0; i < robot->names.size(); ++i) {
      const std::string& name = robot->names[i];
      if (2 * counts[name] < static_cast<int>(robots.size()) ||
          std::ranges::find(population.names, name) != population.names.end())
        continue;
      population.names.push_back(name);
      nominal.push_back(robot->nominal[static_cast<Eigen::Index>(i)]);
      tolerance.push_back(robot->tolerance[static_cast<Eigen::Index>(i)]);
    }
  const auto n = static_cast<Eigen::Index>(nominal.size());
  population.nominal = Eigen::Map<const VectorXd>(nominal.data(), n);
  population.tolerance = Eigen::Map<const VectorXd>(tolerance.data(), n);
  return population;
}

}  // namespace

std::optional<PopulationPrior> fit_population(std::span<const ParameterInformation* const> sample) {
  PopulationPrior population = common_parameters(sample);
  const auto n = static_cast<Eigen::Index>(population.names.size());
  std::vector<RobotLikelihood> likelihoods;
  for (const ParameterInformation* robot : sample)
    if (auto likelihood = likelihood_of(*robot, population)) likelihoods.push_back(std::move(*likelihood));
  if (n == 0 || static_cast<int>(likelihoods.size()) < thresholds::fewest_robots) return std::nullopt;
  Robots robots;
  for (const RobotLikelihood& likelihood : likelihoods) robots.push_back(&likelihood);

  const Shrinkage shrinkage = select_shrinkage(robots, n);
  population.pseudo_robots = shrinkage.uncorrelated;
  Gaussian fitted = fit_gaussian(robots, n, shrinkage);
  const auto count = static_cast<double>(robots.size());
  fitted.covariance *= 1.0 + 1.0 / (count + thresholds::nominal_robots);  // of the mean itself
  population.mean = population.nominal + population.tolerance.cwiseProduct(fitted.mean);
  population.covariance = population.tolerance.asDiagonal() * fitted.covariance * population.tolerance.asDiagonal();
  population.robots = static_cast<int>(robots.size());
  return population;
}

}  // namespace kinfer::fleet
