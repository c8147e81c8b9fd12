// SPDX-License-Identifier: Apache-2.0
// Paper 2 reproduced: its tables 1-8 and figures 6-15 on simulated data, with all methods compared.
//
//   ./dev study paper2 OUT [threads [seeds]]
//
// With `seeds` every comparison runs over that number instead of 20 and 100: a short run, whose tables do not depend on
// the number of threads, except for times.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "comparison.hpp"
#include "compensation.hpp"
#include "error_before.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "studies/studies.hpp"

namespace kinfer::paper2 {
namespace {

const std::vector<Method> every_method(std::begin(all_methods), std::end(all_methods));

/// The folder, and the summary that grows with each section.
struct Study {
  std::filesystem::path folder;
  int threads = 2;
  int few_seeds = 20, many_seeds = 100;
  std::string summary;

  void section(const std::string& title) {
    summary += fmt::format("\n## {}\n\n", title);
    fmt::print(stderr, "{}\n", title);
  }
  void add_text(const std::string& sentence) { summary += sentence + "\n\n"; }
  void table(const std::string& file, const TextTable& table) {
    write(folder / file, table.csv());
    summary += table.markdown() + "\n";
  }
  void figure(const std::string& file, const std::string& svg, const std::string& title) {
    write(folder / file, svg);
    summary += fmt::format("![{}]({})\n\n", title, file);
  }
};

std::vector<double> errors_mm(const Chain& chain, const PoseSet& set) {
  std::vector<double> errors = point_errors(chain, set);
  for (double& e : errors) e *= 1e3;
  return errors;
}

Chain chain_of(const Problem& problem, const Trial& trial) {
  return unpack(problem.parameters, problem.nominal, trial.x);
}

TextTable rows_of(const Table& errors) {
  TextTable table{{"linkage", "da [mm]", "dd [mm]", "dtheta [deg]", "dalpha [deg]"}, {}};
  for (int row = 0; row < 6; ++row) {
    std::vector<std::string> cells{fmt::format("{}", row + 1)};
    for (int k = 0; k < 4; ++k) cells.push_back(fmt::format("{:.4f}", errors[4 * row + k]));
    table.rows.push_back(cells);
  }
  return table;
}

Table identified_errors(const Problem& problem, const Trial& trial) {
  return errors_as_printed(trial.x - pack(problem.parameters, problem.nominal));
}

std::vector<double> in_square_millimetres(std::vector<double> squares) {
  for (double& s : squares) s *= 1e6;
  return squares;
}

void printed_tables(Study& study) {
  study.section("Tables 1 and 3, and what tables 4 and 5 fit");
  TextTable nominal{{"linkage", "a [mm]", "d [mm]", "alpha [deg]"}, {}};
  const Chain robot = er20(d6_printed);
  for (int j = 0; j < 6; ++j) {
    const auto& row = std::get<MdhLink>(robot.joints[j].link);
    nominal.rows.push_back({fmt::format("{}", j + 1), fmt::format("{:.3f}", 1e3 * row.a),
                            fmt::format("{:.3f}", 1e3 * row.d), fmt::format("{:.0f}", row.alpha / degree)});
  }
  study.table("table1_nominal.csv", nominal);
  study.table("table3_errors.csv", rows_of(table3));
  study.table("tables4_5_against_table3.csv", error_before_table());
  study.add_text(
      "Tables 4 and 5 fit table 3 only with d6 = 225 mm: the target's offset belongs to d6 (section 2.2.2).");
}

/// One seed in full: identified errors, errors pose by pose, convergence. Used for the simulation and the experiment.
void write_one_seed(Study& study, const Problem& problem, const Earlier& earlier, const std::string& prefix,
                    const std::string& numbers_tables, const std::string& before, const std::string& pso_errors,
                    const std::string& bpnn_errors, const std::string& pso_convergence,
                    const std::string& bpnn_convergence) {
  const Effort effort{.max_iterations = 600, .threads = 1};
  const Trial pso = run(Method::pso, problem, earlier, 1, effort),
              bpnn = run(Method::bpnn_pso, problem, earlier, 1, effort);
  study.figure(before,
               bar_svg(prefix + ": position error before compensation", "pose", "error [mm]",
                       errors_mm(problem.nominal, problem.verify)),
               "before");
  study.figure(pso_errors,
               bar_svg(prefix + ": error after compensation, PSO", "pose", "error [mm]",
                       errors_mm(chain_of(problem, pso), problem.verify)),
               "PSO");
  study.figure(bpnn_errors,
               bar_svg(prefix + ": error after compensation, BPNN-PSO", "pose", "error [mm]",
                       errors_mm(chain_of(problem, bpnn), problem.verify)),
               "BPNN-PSO");
  study.figure(pso_convergence,
               line_svg(prefix + ": convergence of PSO", "iteration", "sum of squares [mm²]",
                        {{"PSO", in_square_millimetres(pso.best)}}),
               "PSO");
  study.figure(bpnn_convergence,
               line_svg(prefix + ": convergence of BPNN-PSO", "iteration", "sum of squares [mm²]",
                        {{"BPNN-PSO", in_square_millimetres(bpnn.best)}}),
               "BPNN-PSO");
  study.add_text("Errors identified by PSO:");
  study.table("table" + numbers_tables.substr(0, 1) + "_identified_pso.csv", rows_of(identified_errors(problem, pso)));
  study.add_text("Errors identified by BPNN-PSO:");
  study.table("table" + numbers_tables.substr(1, 1) + "_identified_bpnn_pso.csv",
              rows_of(identified_errors(problem, bpnn)));
}

Scenario same_robot(const std::string& name, const Conditions& now) {
  Conditions before = now;
  before.drift = 0.0;
  before.collision = before.another_robot = false;
  return {name, [before](int seed) { return simulation(before, 2000 + seed, 1); },
          [now](int seed) { return simulation(now, 3000 + seed, 100 + seed); }};
}

void simulation_section(Study& study) {
  study.section("Section 4: simulation (as figures 6-10, tables 4 and 5)");
  const Problem problem = simulation({}, 1, 1);
  write_one_seed(study, problem, identify_before(simulation({}, 2, 1), 1), "Simulation", "45", "figure6_before.svg",
                 "figure9_after_pso.svg", "figure10_after_bpnn_pso.svg", "figure7_convergence_pso.svg",
                 "figure8_convergence_bpnn_pso.svg");
  for (const double d6 : {d6_printed, d6_with_target}) {
    study.add_text(fmt::format(
        "All methods, d6 = {:.0f} mm, noise-free, {} seeds; iterations to rms 7.45 µm (the paper's fitness read as a "
        "mean) and to a sum of 5.55e-5 mm² (as printed):",
        1e3 * d6, study.few_seeds));
    study.table(fmt::format("methods_d6_{:.0f}.csv", 1e3 * d6),
                comparison_table(
                    compare(same_robot("same robot", {.d6 = d6}), every_method, study.few_seeds, {}, study.threads)));
  }
}

void headline_section(Study& study) {
  study.section(fmt::format("Headline: {} seeds, d6 = 225 mm", study.many_seeds));
  const auto trials =
      compare(same_robot("same robot", {}), {Method::pso, Method::bpnn_pso}, study.many_seeds, {}, study.threads);
  study.table("headline_100_seeds.csv", comparison_table(trials));
  const double cold = median_iterations(trials[0]), net = median_iterations(trials[1]);
  study.add_text(
      fmt::format("Cold PSO (w = 0.8) reaches rms 7.45 µm within 404 iterations in {} of {} seeds; BPNN-PSO needs "
                  "{:.2f} of its iterations "
                  "(medians {:.0f} and {:.0f}; paper: 71/404 = 0.18).",
                  hits_within(trials[0], 404), study.many_seeds, net / cold, net, cold));
}

void variants_section(Study& study) {
  study.section(fmt::format("Drift, a collision, another robot, noise ({} seeds each)", study.few_seeds));
  const Instrument laser{.sigma = 10e-6, .sigma_angle = 0.0, .ppm = 5.0};
  const std::pair<const char*, Conditions> variants[] = {
      {"drift_1_percent", {.drift = 0.01}},       {"drift_10_percent", {.drift = 0.10}},
      {"drift_50_percent", {.drift = 0.50}},      {"collision", {.collision = true}},
      {"another_robot", {.another_robot = true}}, {"noise", {.instrument = laser}}};
  for (const auto& [name, conditions] : variants) {
    study.add_text(fmt::format("### {}", name));
    study.table(
        fmt::format("methods_{}.csv", name),
        comparison_table(compare(same_robot(name, conditions), every_method, study.few_seeds, {}, study.threads)));
  }
}

TextTable table8(const Problem& problem, const Earlier& earlier) {
  TextTable table{
      {"method", "mean [mm]", "sd [mm]", "max [mm]", "iterations", "fitness [mm²]", "search [s]", "training [s]"}, {}};
  for (const Method method : every_method) {
    const Trial t = run(method, problem, earlier, 1, {.max_iterations = 1000, .threads = 1});
    table.rows.push_back({name(method), fmt::format("{:.4f}", 1e3 * t.held_out.mean),
                          fmt::format("{:.4f}", 1e3 * t.held_out.sd), fmt::format("{:.4f}", 1e3 * t.held_out.max),
                          t.iterations < 0 ? "not reached" : fmt::format("{}", t.iterations),
                          fmt::format("{:.4f}", 1e6 * t.fitted.n * t.fitted.rms * t.fitted.rms),
                          fmt::format("{:.4f}", t.seconds), fmt::format("{:.2f}", t.training_seconds)});
  }
  return table;
}

void experiment_section(Study& study) {
  study.section(
      "Section 5, simulated: an experiment with noise, compliance and a base error (as figures 11-15, tables 6-8)");
  const Problem problem = experiment(1);
  const Earlier earlier = identify_before(experiment(2), 1);
  write_one_seed(study, problem, earlier, "Experiment", "67", "figure11_before.svg", "figure12_after_pso.svg",
                 "figure13_after_bpnn_pso.svg", "figure14_convergence_pso.svg", "figure15_convergence_bpnn_pso.svg");
  study.add_text(
      "Compensated joint targets sent to the robot, 50 held-out poses: the tool misses by the identified model's own "
      "error (medians; poses whose compensated joints lie within the limits):");
  study.table("compensation.csv", compensation_table(problem, earlier));
  study.add_text("As table 8: one experiment, times on one thread:");
  study.table("table8.csv", table8(problem, earlier));
  study.add_text(fmt::format("The same over {} experiments:", study.few_seeds));
  const Scenario scenario{"experiment", [](int seed) { return experiment(2000 + seed); },
                          [](int seed) { return experiment(3000 + seed); }};
  study.table("methods_experiment.csv",
              comparison_table(compare(scenario, every_method, study.few_seeds, {}, study.threads)));
}

void ur10_section(Study& study) {
  study.section("A real robot: UR10 under a Leica tracker, 50 rows to fit and 50 to verify");
  if (!ur10(1)) {
    study.add_text("Left out: KINFER_DATA is not set or the data are not there.");
    return;
  }
  const Scenario scenario{"ur10", [](int seed) { return *ur10(2000 + seed); },
                          [](int seed) { return *ur10(3000 + seed); }};
  study.table("methods_ur10.csv", comparison_table(compare(scenario, every_method, study.few_seeds,
                                                           {.max_iterations = 1000}, study.threads)));
}

}  // namespace
}  // namespace kinfer::paper2

int kinfer::study::run_paper2(int argc, char** argv) {
  using namespace kinfer::paper2;
  if (argc < 2 || argc > 4) {
    fmt::print(stderr, "usage: ./dev study {} OUT [threads [seeds]]\n", argv[0]);
    return 2;
  }
  Study study{
      .folder = argv[1],
      .threads = argc > 2 ? std::atoi(argv[2]) : 0,
      .summary =
          "# Paper 2, reproduced\n\nWritten by ./dev study paper2; docs/development/methods/paper2.md says what the "
          "figures mean.\n"};
  if (argc > 3) study.few_seeds = study.many_seeds = std::atoi(argv[3]);
  std::filesystem::create_directories(study.folder);
  printed_tables(study);
  simulation_section(study);
  headline_section(study);
  variants_section(study);
  experiment_section(study);
  ur10_section(study);
  write(study.folder / "summary.md", study.summary);
  fmt::print("{}", study.summary);
  return 0;
}
