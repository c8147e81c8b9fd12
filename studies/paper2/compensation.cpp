// SPDX-License-Identifier: Apache-2.0
#include "compensation.hpp"

#include <fmt/format.h>

#include "kinfer/deploy/compensate.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::paper2 {
using namespace deploy;
namespace {

std::vector<std::string> row(const std::string& method, const std::vector<double>& misses,
                             const std::vector<double>& model_errors) {
  if (misses.empty()) return {method, "0", "", "", "", "", ""};
  const ErrorStatistics miss = error_statistics(misses), model_error = error_statistics(model_errors);
  const auto millimetres = [](double value) { return fmt::format("{:.4f}", 1e3 * value); };
  return {method,
          fmt::format("{}", miss.n),
          millimetres(miss.mean),
          millimetres(median(misses)),
          millimetres(miss.max),
          millimetres(median(model_errors)),
          millimetres(model_error.max)};
}

/// Sends the joint positions compensated by `model` to the real robot.
std::vector<std::string> row_of(const std::string& method, const Problem& problem, const Chain& model) {
  const MatrixXd& targets = problem.verify.joints;
  const std::vector<CompensatedJoints> compensated = compensate_joints(model, problem.nominal, targets, 1);
  std::vector<double> misses, model_errors;
  for (std::size_t i = 0; i < compensated.size(); ++i) {
    if (compensated[i].status != InverseStatus::reached) continue;
    const Vec3 reached = forward(problem.truth, compensated[i].q).position;
    misses.push_back((reached - forward(problem.nominal, targets.col(static_cast<Eigen::Index>(i))).position).norm());
    model_errors.push_back((reached - forward(model, compensated[i].q).position).norm());
  }
  return row(method, misses, model_errors);
}

}  // namespace

TextTable compensation_table(const Problem& problem, const Earlier& earlier) {
  TextTable table{{"model", "poses", "miss mean [mm]", "miss median [mm]", "miss max [mm]", "model error median [mm]",
                   "model error max [mm]"},
                  {}};
  table.rows.push_back(row_of("nominal", problem, problem.nominal));
  for (const Method method : {Method::pso, Method::bpnn_pso, Method::lm, Method::map_lm}) {
    const Trial trial = run(method, problem, earlier, 1, {.max_iterations = 1000, .threads = 1});
    table.rows.push_back(row_of(name(method), problem, unpack(problem.parameters, problem.nominal, trial.x)));
  }
  return table;
}

}  // namespace kinfer::paper2
