// SPDX-License-Identifier: Apache-2.0
#include "trials.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::study::planning_study {
using namespace calibrate;
using namespace plan;
namespace {

Result<Chain> fit_by_default(const CalibrationTask& task) {
  KINFER_TRY(found, calibrate_robot(task, {.threads = 1}, Rng(1)));
  return found.estimate.chain;
}

Result<Chain> fit_by_plain_least_squares(const CalibrationTask& task) {
  KINFER_TRY(prepared, prepare_fit(task, task.data, GeometricParameters{}, {1000.0}));
  return fit_bundle(prepared.start, prepared.parameters, task.data, task.instrument,
                    {.outliers = Outliers::keep_all, .detail = Detail::numbers_only})
      .chain;
}

}  // namespace

const char* name(Fitting fitting) {
  return fitting == Fitting::by_default ? "default" : "plain least squares";
}

Errors errors_of(const CalibrationTask& task, Fitting fitting, const PoseSet& train, const PoseSet& rest) {
  CalibrationTask training = task;
  training.data = train;
  const auto found = fitting == Fitting::by_default ? fit_by_default(training) : fit_by_plain_least_squares(training);
  if (!found) return {1.0, 1.0};
  const std::vector<double> errors = point_errors(*found, rest);
  return {mean(errors), *std::max_element(errors.begin(), errors.end())};
}

Errors medians_of(const std::function<Errors(int)>& trial) {
  std::vector<double> means(draws), worsts(draws);
  parallel_for(draws, 0, [&](std::size_t draw) {
    const Errors e = trial(static_cast<int>(draw));
    means[draw] = e.mean, worsts[draw] = e.worst;
  });
  return {median(means), median(worsts)};
}

std::string row(const std::string& set, Fitting fitting, const std::string& choice, const Errors& e,
                const Errors& random) {
  const std::string line = fmt::format("{},{},{},{:.4f},{:.4f},{:.2f},{:.2f}\n", set, name(fitting), choice,
                                       1e3 * e.mean, 1e3 * e.worst, e.mean / random.mean, e.worst / random.worst);
  fmt::print("{}", line);
  return line;
}

}  // namespace kinfer::study::planning_study
