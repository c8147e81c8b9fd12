// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/fit/population_choice.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/calibrate/fit/thresholds.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/parameter_information.hpp"

namespace kinfer::calibrate {
namespace {

/// Mean and covariance of a prior, in the data sheet's tolerances from nominal.
struct JointPrior {
  VectorXd mean;
  MatrixXd covariance;
};

/// The tolerances that the fit used: those of the data sheet, or multiples of them.
JointPrior own_prior(const ParameterInformation& data, const Estimate& fit) {
  const auto n = static_cast<Eigen::Index>(data.names.size());
  JointPrior prior{VectorXd::Zero(n), MatrixXd::Identity(n, n)};
  for (Eigen::Index i = 0; i < n; ++i)
    if (const Parameter* parameter = fit.parameters.find(data.names[static_cast<std::size_t>(i)]))
      prior.covariance(i, i) = std::pow(parameter->prior_sd / data.tolerance[i], 2);
  return prior;
}

/// The population's, and the robot's own for parameters that it does not name.
JointPrior population_prior(const ParameterInformation& data, const PopulationPrior& population, JointPrior own) {
  std::vector<Eigen::Index> here, there;
  for (std::size_t i = 0; i < data.names.size(); ++i)
    if (const auto at = std::ranges::find(population.names, data.names[i]); at != population.names.end())
      here.push_back(static_cast<Eigen::Index>(i)), there.push_back(at - population.names.begin());
  for (std::size_t i = 0; i < here.size(); ++i) {
    own.mean[here[i]] = (population.mean[there[i]] - data.nominal[here[i]]) / data.tolerance[here[i]];
    for (std::size_t j = 0; j < here.size(); ++j)
      own.covariance(here[i], here[j]) =
          population.covariance(there[i], there[j]) / (data.tolerance[here[i]] * data.tolerance[here[j]]);
  }
  return own;
}

}  // namespace

Result<PopulationChoice> choose_population(const CalibrationTask& task, const PoseSet& fitted,
                                           const ParameterChoice& parameters, Rng rng) {
  if (!task.population) return PopulationChoice{task};
  CalibrationTask alone = task;
  alone.population.reset();
  KINFER_TRY(fit, fit_with_scaled_tolerances(alone, fitted, parameters, rng));
  const auto data = information_of(fit.estimate, {task.nominal, task.tolerances});
  if (!data) return PopulationChoice{task};
  const JointPrior own = own_prior(*data, fit.estimate), population = population_prior(*data, *task.population, own);
  const auto with = log_marginal_likelihood(*data, population.mean, population.covariance),
             without = log_marginal_likelihood(*data, own.mean, own.covariance);
  if (!with || !without) return PopulationChoice{task};
  const double log_odds = *with - *without;
  const bool is_foreign = log_odds < -std::log(thresholds::foreign_odds);
  const CalibrationNote note{
      is_foreign ? CalibrationNoteKind::foreign_to_population : CalibrationNoteKind::population_used,
      {{"robots", task.population->robots}, {"log_odds", log_odds}}};
  return PopulationChoice{is_foreign ? alone : task, note};
}

}  // namespace kinfer::calibrate
