// SPDX-License-Identifier: Apache-2.0
// Choosing among measured poses: each draw plans among another half of them and is evaluated on all others.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/calibrate/fit/tolerance_fit.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/words/findings/row_ranges.hpp"
#include "trials.hpp"

namespace kinfer::study::planning_study {
using namespace calibrate;
using namespace plan;
namespace {

/// `count` of the rows, in random order.
std::vector<int> random_subset(std::vector<int> rows, int count, Rng rng) {
  for (int i = 0; i < count; ++i) std::swap(rows[i], rows[i + rng.index(rows.size() - i)]);
  rows.resize(count);
  return rows;
}

class Series {
 public:
  Series(const RobotModel& robot, const PoseSet& data, std::string words)
      : task_{.nominal = robot.chain, .tolerances = robot.tolerances, .instrument = robot.instrument, .data = data},
        words_(std::move(words)) {
    exclude_gross_errors();
  }

  std::string table() const {
    std::string table;
    for (const Fitting fitting : all_fittings) {
      const auto of = [&](const auto& chosen) {
        return medians_of([&](int draw) { return held_out(fitting, chosen(draw)); });
      };
      const Errors random = of([&](int draw) { return random_subset(valid_rows_, poses, Rng(7).stream(draw)); });
      table += row(words_, fitting, "random", random, random);
      for (const NamedCriterion& by : all_criteria)
        table += row(words_, fitting, by.name, of([&](int draw) { return planned(by.criterion, draw); }), random);
      // Evaluated on the fitted rows: a lower bound for any choice.
      table += row(words_, fitting, "all rows fitted",
                   errors_of(task_, fitting, task_.data, select(task_.data, valid_rows_)), random);
    }
    return table;
  }

 private:
  void exclude_gross_errors() {
    std::set<int> gross_errors;
    const Diagnosis diagnosis = diagnose(task_);
    for (const Finding& finding : diagnosis.findings) gross_errors.insert(finding.rows.begin(), finding.rows.end());
    const Estimate of_all_rows = fit_once(task_, task_.data, GeometricParameters{}, {}).value();
    for (const Outlier& outlier : of_all_rows.outliers) gross_errors.insert(outlier.row);
    for (int row = 0; row < task_.data.rows(); ++row)
      if (!gross_errors.contains(row)) valid_rows_.push_back(row);
    fmt::print("{}: neither chosen nor held out, gross errors by the diagnosis or the fit of all rows: {}\n", words_,
               words::row_ranges(std::vector<int>(gross_errors.begin(), gross_errors.end())));
  }

  std::vector<int> planned(Criterion criterion, int draw) const {
    const std::vector<int> half =
        random_subset(valid_rows_, static_cast<int>(valid_rows_.size()) / 2, Rng(8).stream(draw));
    PlanTask choice;
    choice.nominal = task_.nominal, choice.tolerances = task_.tolerances;
    choice.instrument = {.sigma = 2e-4, .sigma_angle = 1e-3};
    choice.candidates = task_.data.joints(Eigen::all, half);
    const PosePlan plan = plan_poses(choice, {.poses = poses, .criterion = criterion, .threads = 1}, Rng(1)).value();
    std::vector<int> rows;
    for (const int i : plan.candidates) rows.push_back(half[i]);
    return rows;
  }

  Errors held_out(Fitting fitting, const std::vector<int>& fitted) const {
    std::vector<int> rest = valid_rows_;
    std::erase_if(rest, [&](int row) { return std::find(fitted.begin(), fitted.end(), row) != fitted.end(); });
    return errors_of(task_, fitting, select(task_.data, fitted), select(task_.data, rest));
  }

  CalibrationTask task_;
  std::string words_;
  std::vector<int> valid_rows_;
};

}  // namespace

Result<std::string> measured_robot(const std::string& folder) {
  KINFER_TRY(robot, read_robot_toml("data/ur10/robot.toml"));
  KINFER_TRY(map, read_column_map("data/ur10/leica_columns.toml"));
  std::string table;
  struct File {
    const char *words, *name;
  };
  constexpr File files[] = {{"UR10 series B", "Series_B_measurements_joint_configurations.csv"},
                            {"UR10 series C", "Series_C_measurements_random_poses.csv"}};
  for (const File& file : files) {
    KINFER_TRY(series, read_pose_set(std::filesystem::path(folder) / file.name, robot.chain, map));
    series.orientations.clear();
    table += Series(robot, series, file.words).table();
  }
  return table;
}

}  // namespace kinfer::study::planning_study
