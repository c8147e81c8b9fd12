#include "trials.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/single_fit.hpp"
#include "kinfer/estimate/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"

namespace kinfer::study {
namespace {

Result<Chain> found_by_default(const CalibrateTask& task) {
  KINFER_TRY(found, calibrate(task, {.threads = 1}, Rng(1)));
  return found.estimate.chain;
}

Result<Chain> found_by_plain_least_squares(const CalibrateTask& task) {
  KINFER_TRY(prepared, prepare_fit(task, task.data, AutoParameters{}, {1000.0}));
  return fit_bundle(prepared.start, prepared.parameters, task.data, task.instrument,
                    {.outliers = Outliers::believe_all, .detail = Detail::numbers_only})
      .chain;
}

}  // namespace

const char* name(Fitting fitting) {
  return fitting == Fitting::by_default ? "default" : "plain least squares";
}

Errors errors_of(const CalibrateTask& task, Fitting fitting, const PoseSet& train, const PoseSet& rest) {
  CalibrateTask seen = task;
  seen.data = train;
  const auto found = fitting == Fitting::by_default ? found_by_default(seen) : found_by_plain_least_squares(seen);
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

}  // namespace kinfer::study
