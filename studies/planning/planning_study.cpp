// What chosen poses are worth: 15 planned ones against 15 random ones, by the error on poses that were not fitted.
//
//   study_planning OUT [FOLDER_OF_UR10_SERIES]
//
// Simulated: a UR10-like robot with an unknown tracker frame, 10 µm + 5 µm/m, errors drawn from the tolerances.
// Measured: series B of the public UR10 set (data/ur10/robot.toml names the source), choosing among its own poses.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/doctor.hpp"
#include "kinfer/calibrate/doctor_case.hpp"
#include "kinfer/calibrate/plan.hpp"
#include "kinfer/calibrate/single_fit.hpp"
#include "kinfer/estimate/residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/io/pose_set_csv.hpp"
#include "kinfer/io/robot_toml.hpp"
#include "kinfer/io/text_file.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/simulate/pose_set.hpp"

namespace kinfer {
namespace {

constexpr int poses = 15, draws = 20;

struct Criteria {
  Criterion criterion;
  const char* name;
};
constexpr Criteria all_criteria[] = {{Criterion::tool, "tool"},
                                     {Criterion::worst, "worst"},
                                     {Criterion::d, "D"},
                                     {Criterion::a, "A"},
                                     {Criterion::e, "E"}};

struct Errors {
  double mean = 0.0, worst = 0.0;  // [m]
};

/// What `kinfer calibrate` makes of `train` with its defaults, judged on `rest`.
Errors errors_of(const CalibrateTask& task, const PoseSet& train, const PoseSet& rest) {
  CalibrateTask seen = task;
  seen.data = train;
  const auto found = calibrate(seen, {.threads = 1}, Rng(1));
  if (!found) return {1.0, 1.0};
  const std::vector<double> errors = point_errors(found->estimate.chain, rest);
  return {mean(errors), *std::max_element(errors.begin(), errors.end())};
}

/// Judged on the rows that were not fitted and are not wrong.
Errors held_out(const CalibrateTask& task, const std::vector<int>& fitted, const std::set<int>& wrong) {
  std::vector<int> rest;
  for (int row = 0; row < task.data.rows(); ++row)
    if (!wrong.contains(row) && std::find(fitted.begin(), fitted.end(), row) == fitted.end()) rest.push_back(row);
  return errors_of(task, select(task.data, fitted), select(task.data, rest));
}

std::vector<int> random_rows(Eigen::Index count, Rng rng) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  for (int i = 0; i < poses; ++i) std::swap(all[i], all[i + rng.index(all.size() - i)]);
  all.resize(poses);
  return all;
}

Errors medians(const std::vector<Errors>& list) {
  std::vector<double> means, worsts;
  for (const Errors& e : list) means.push_back(e.mean), worsts.push_back(e.worst);
  return {median(means), median(worsts)};
}

std::string row(const std::string& set, const std::string& choice, const Errors& e, const Errors& random) {
  const std::string line = fmt::format("{},{},{:.4f},{:.4f},{:.3f},{:.3f}\n", set, choice, 1e3 * e.mean, 1e3 * e.worst,
                                       e.mean / random.mean, e.worst / random.worst);
  fmt::print("{}", line);
  return line;
}

PlanTask plan_task(const RobotModel& task, const Instrument& instrument, const MatrixXd& candidates) {
  PlanTask plan;
  plan.nominal = task.chain;
  plan.tolerances = task.tolerances;
  plan.instrument = instrument;
  plan.candidates = candidates;
  return plan;
}

/// The tool of `truth` at the readings q, seen without noise or with the tracker's.
PoseSet seen(const Chain& truth, const MatrixXd& q, const Instrument& tracker, Rng noise) {
  PoseSet set;
  set.joint_names = reading_names(truth);
  set.joints = q;
  const PoseEvaluator evaluator(truth, {});
  for (int row = 0; row < q.cols(); ++row) {
    const Vec3 p = evaluator.pose(q.col(row)).position;
    const Vec3 error = position_sd(tracker, p) * Vec3(noise.normal(), noise.normal(), noise.normal());
    set.points.push_back({.row = row, .target = -1, .position = p + error, .sd = {}});
    set.line.push_back(row + 2);
  }
  return set;
}

/// One plan a criterion; each draw has its own true robot and noise, and is judged without noise at 1000 random poses.
std::string simulated(const RobotModel& robot) {
  const Instrument tracker{.sigma = 10e-6, .sigma_angle = 0.0, .ppm = 5};
  const MatrixXd elsewhere = draw_poses(robot.chain, {}, 1000, Rng(200)).value();
  const auto judged = [&](int draw, const MatrixXd& q) {
    const Chain truth = with_random_errors(robot.chain, robot.tolerances, Rng(100).stream(draw));
    const CalibrateTask task{.nominal = robot.chain,
                             .tolerances = robot.tolerances,
                             .instrument = tracker,
                             .data = seen(truth, q, tracker, Rng(300).stream(draw))};
    return errors_of(task, task.data, seen(truth, elsewhere, {}, Rng(1)));
  };
  const auto median_of_draws = [&](const std::function<MatrixXd(int)>& poses_of) {
    std::vector<Errors> list;
    for (int draw = 0; draw < draws; ++draw) list.push_back(judged(draw, poses_of(draw)));
    return medians(list);
  };
  const Errors by_chance =
      median_of_draws([&](int draw) { return draw_poses(robot.chain, {}, poses, Rng(7).stream(draw)).value(); });
  std::string table = row("simulated UR10-like", "random", by_chance, by_chance);
  for (const auto& [criterion, name] : all_criteria) {
    const PosePlan plan =
        plan_poses(plan_task(robot, tracker, {}), {.poses = poses, .criterion = criterion}, Rng(1)).value();
    if (plan.least_rms > 0.0)
      fmt::print("expected rms {:.4f} mm, worst place {:.4f}; no choice of {} leaves less than {:.4f}; random {:.4f}\n",
                 1e3 * plan.expected.rms, 1e3 * plan.expected.worst, poses, 1e3 * plan.least_rms,
                 1e3 * plan.random.rms);
    table += row("simulated UR10-like", name, median_of_draws([&](int) { return plan.joints; }), by_chance);
  }
  return table;
}

std::vector<int> every_row(const PoseSet& data) {
  std::vector<int> rows(data.rows());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// Choosing among measured poses; the fit to all of them, judged on those it saw, is the least that any choice leaves.
std::string measured(const RobotModel& robot, PoseSet data, const std::string& name) {
  const CalibrateTask task{
      .nominal = robot.chain, .tolerances = robot.tolerances, .instrument = robot.instrument, .data = data};
  std::set<int> wrong;
  const Diagnosis diagnosis = examine(task);
  for (const Finding& finding : diagnosis.findings) wrong.insert(finding.rows.begin(), finding.rows.end());
  const Estimate of_all_rows = fit_once(task, data, AutoParameters{}, {}).value();
  for (const Outlier& outlier : of_all_rows.outliers) wrong.insert(outlier.row);
  std::vector<int> right = every_row(data);
  std::erase_if(right, [&](int r) { return wrong.contains(r); });
  fmt::print("not held out, as the doctor or the fit of all rows does not believe them: {}\n",
             rows_in_words(std::vector<int>(wrong.begin(), wrong.end())));
  std::vector<Errors> random;
  for (int draw = 0; draw < draws; ++draw)
    random.push_back(held_out(task, random_rows(data.rows(), Rng(7).stream(draw)), wrong));
  const Errors by_chance = medians(random);
  std::string table = row(name, "random", by_chance, by_chance);
  for (const auto& [criterion, words] : all_criteria) {
    const PlanTask choice = plan_task(robot, {.sigma = 2e-4, .sigma_angle = 1e-3}, data.joints);
    const PosePlan plan = plan_poses(choice, {.poses = poses, .criterion = criterion}, Rng(1)).value();
    table += row(name, words, held_out(task, plan.candidates, wrong), by_chance);
  }
  table += row(name, "all rows fitted", errors_of(task, data, select(data, right)), by_chance);
  return table;
}

}  // namespace
}  // namespace kinfer

int main(int argc, char** argv) {
  using namespace kinfer;
  const std::filesystem::path out = argc > 1 ? argv[1] : "out/planning", data = argc > 2 ? argv[2] : "";
  const auto robot = read_robot_toml("data/ur10/robot.toml");
  if (!robot) return fmt::print(stderr, "{}\n", robot.error().what), 2;
  std::string table = "set,choice,mean_mm,worst_mm,mean_ratio,worst_ratio\n";
  table += simulated(*robot);
  if (!data.empty()) {
    const auto map = read_column_map("data/ur10/leica_columns.toml");
    const auto series = read_pose_set(data / "Series_B_measurements_joint_configurations.csv", robot->chain, *map);
    if (!series) return fmt::print(stderr, "{}\n", series.error().what), 2;
    table += measured(*robot, *series, "UR10 series B (poses)");
    PoseSet positions = *series;
    positions.orientations.clear();
    table += measured(*robot, positions, "UR10 series B (positions)");
  }
  std::filesystem::create_directories(out);
  return write_text_file(out / "planning.csv", table) ? 0 : 2;
}
