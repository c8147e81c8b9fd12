// SPDX-License-Identifier: Apache-2.0
#include "error_before.hpp"

#include <fmt/format.h>

#include <functional>
#include <map>

#include "er20.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/evidence/calibration/fit_errors.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/simulate/pose_set.hpp"

namespace kinfer::paper2 {
namespace {

constexpr int pose_count = 20000, set_size = 50;

struct PoseRule {
  std::string name;
  std::function<MatrixXd(const Chain& nominal)> joints;
};

MatrixXd as_drawn(const Chain& nominal) {
  return drawn_joints(nominal, pose_count, Rng(5));
}

/// Joint 4 loses the 30° next to its ends, where the error is smallest, and joint 5 its ends.
MatrixXd with_a_narrow_wrist(const Chain& nominal) {
  Chain narrow = nominal;
  for (const auto& [joint, limit] : {std::pair{3, 150 * degree}, {4, 100 * degree}})
    narrow.joints[joint].lower = -limit, narrow.joints[joint].upper = limit;
  return drawn_joints(narrow, pose_count, Rng(5));
}

/// Section 5.1: tool positions "distributed evenly in the working space": a ring (radius × height cells of 100 mm)
/// drawn by its volume, then one of the poses whose tool is in it.
MatrixXd evenly_in_the_work_space(const Chain& nominal) {
  constexpr double cell = 100 * millimetre;
  const MatrixXd joints = drawn_joints(nominal, 5 * pose_count, Rng(5));
  std::map<std::pair<int, int>, std::vector<int>> rings;
  for (int i = 0; i < joints.cols(); ++i) {
    const Vec3 tool = forward(nominal, joints.col(i)).position;
    rings[{int(tool.head<2>().norm() / cell), int(tool.z() / cell)}].push_back(i);
  }
  std::vector<const std::vector<int>*> by_volume;  // a ring's volume goes with 2 i + 1
  for (const auto& [where, poses] : rings) by_volume.insert(by_volume.end(), 2 * where.first + 1, &poses);
  Rng rng(6);
  MatrixXd even(6, pose_count);
  for (int i = 0; i < pose_count; ++i) {
    const std::vector<int>& poses = *by_volume[rng.index(by_volume.size())];
    even.col(i) = joints.col(poses[rng.index(poses.size())]);
  }
  return even;
}

/// The `chosen` of these poses whose tools are spread furthest: each next one is furthest from all before it.
std::vector<int> spread_furthest(const MatrixXd& tools, int chosen) {
  std::vector<int> order{0};
  VectorXd distance = (tools.colwise() - tools.col(0)).colwise().squaredNorm();
  while (int(order.size()) < chosen) {
    int next = 0;
    distance.maxCoeff(&next);
    order.push_back(next);
    distance = distance.cwiseMin((tools.colwise() - tools.col(next)).colwise().squaredNorm().transpose());
  }
  return order;
}

/// Section 5.1 literally: each set of 50 is "distributed evenly in the working space as much as possible".
MatrixXd spread_over_the_work_space(const Chain& nominal) {
  constexpr int candidates = 2000;  // from 1000 to 5000 the two means move by less than 0.01 mm
  MatrixXd spread(6, pose_count);
  for (int from = 0; from < pose_count; from += set_size) {
    const MatrixXd joints = drawn_joints(nominal, candidates, Rng(7).stream(from));
    MatrixXd tools(3, candidates);
    for (int i = 0; i < candidates; ++i) tools.col(i) = forward(nominal, joints.col(i)).position;
    spread.middleCols(from, set_size) = joints(Eigen::all, spread_furthest(tools, set_size));
  }
  return spread;
}

/// Standard deviation of a figure between sets of 50 poses.
double scatter_of(const std::vector<double>& errors, double ErrorStatistics::*figure) {
  std::vector<double> values;
  for (int i = 0; i + set_size <= int(errors.size()); i += set_size)
    values.push_back(error_statistics(std::span(errors).subspan(i, set_size)).*figure);
  return standard_deviation(values);
}

std::vector<std::string> row(const PoseRule& rule, double d6) {
  const Chain nominal = er20(d6);
  const PoseSet set = simulate_points(with_errors(nominal, table3), rule.joints(nominal));
  const std::vector<double> before = point_errors(nominal, set);
  const ErrorStatistics all = error_statistics(before);
  std::vector<std::string> cells{rule.name, fmt::format("{:.0f}", 1e3 * d6)};
  for (const auto figure : {&ErrorStatistics::mean, &ErrorStatistics::rms}) {
    cells.push_back(fmt::format("{:.3f}", 1e3 * (all.*figure)));
    cells.push_back(fmt::format("{:.3f}", 1e3 * scatter_of(before, figure)));
  }
  for (const Table& table : {table4, table5}) {
    const ErrorStatistics left = error_statistics(point_errors(with_errors(nominal, table), set));
    cells.push_back(fmt::format("{:.2f}", 1e6 * left.mean));
    cells.push_back(fmt::format("{:.2f}", 1e6 * left.rms));
  }
  return cells;
}

}  // namespace

TextTable error_before_table() {
  const PoseRule rules[] = {{"joints drawn evenly from their limits", as_drawn},
                            {"the same, joint 4 within 150 deg and joint 5 within 100 deg", with_a_narrow_wrist},
                            {"tool evenly in the work space", evenly_in_the_work_space},
                            {"50 tools spread as evenly as possible", spread_over_the_work_space}};
  TextTable table{
      {"poses", "d6 [mm]", "mean error before [mm]", "its sd in sets of 50", "rms before [mm]", "its sd in sets of 50",
       "table 4 leaves mean [um]", "rms [um]", "table 5 leaves mean [um]", "rms [um]"},
      {}};
  for (const PoseRule& rule : rules)
    for (const double d6 : {d6_printed, d6_with_target}) table.rows.push_back(row(rule, d6));
  return table;
}

}  // namespace kinfer::paper2
