// SPDX-License-Identifier: Apache-2.0
// Regret of the automatic choice of model terms: held-out errors of the default over those of the best fixed set of
// terms, on halves of the rows that were never fitted.
//
//   ./dev study regret --help
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/estimate/poses/pose_residuals.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/split.hpp"
#include "kinfer/words/calibration/model.hpp"
#include "studies/studies.hpp"
#include "studies/support/arguments.hpp"
#include "studies/support/data_sets.hpp"

namespace kinfer::study::regret_study {
using namespace calibrate;
namespace {

struct Options {
  std::string only;
  int halves = 5, sets = 29, rows = 0, simulated = 30, rigid = 0, threads = 0, reasons = 0;
};

/// The first ones are those that win most often.
constexpr const char* fixed_sets[] = {"geometry",
                                      "gravity",
                                      "gear",
                                      "gravity+gear",
                                      "gravity+gear+spectrum",
                                      "gear+spectrum",
                                      "gains",
                                      "gains+gravity",
                                      "gains+gear",
                                      "gains+gravity+gear",
                                      "gains+gravity+gear+spectrum",
                                      "torques",
                                      "gravity+torques",
                                      "torques+gear",
                                      "gravity+torques+gear",
                                      "backlash",
                                      "gear+backlash",
                                      "gravity+gear+backlash",
                                      "gravity+gear+spectrum+backlash",
                                      "coupling",
                                      "coupling+gear",
                                      "coupling+gravity+gear",
                                      "spectrum",
                                      "gravity+spectrum",
                                      "gravity+gear+spectrum+backlash+temperature",
                                      "gains+coupling+gravity+torques+gear+spectrum+backlash+temperature",
                                      "field",
                                      "gravity+gear+field",
                                      "gains+gravity+gear+field"};

using ErrorsByRow = std::map<int, double>;  // [m]

/// Half of the rows labelled as held out; linked rows (ball-bars) follow the row they are linked to.
PoseSet with_half_held_out(PoseSet data, int seed) {
  data.set.assign(data.rows(), SplitLabel::train);
  for (const int row : random_split(static_cast<int>(data.rows()), 0.5, Rng(seed)).holdout)
    data.set[row] = SplitLabel::holdout;
  for (const PairDistance& pair : data.pairs) data.set[pair.other] = data.set[pair.row];
  return data;
}

struct Run {
  std::string model, reasons;
  ErrorsByRow errors;
  double seconds = 0.0;
};

Run run(const CalibrationTask& task, const std::string& model, int threads) {
  const auto start = std::chrono::steady_clock::now();
  const auto c = calibrate_robot(task, {.model = parse_model_choice(model).value(), .threads = threads}, Rng(1));
  Run result{model, {}, {}, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  if (!c) return result;
  result.model = selected_model(c->model_selection);
  for (const SelectionStep& step : c->model_selection.steps)
    result.reasons += fmt::format("    {}: {}\n", name(step), words::reason(step));
  for (const RowErrors& row : c->rows)
    if (row.held_out && std::isfinite(row.after)) result.errors[row.row] = row.after;
  return result;
}

/// A row that every model misses by far is a wrong measurement.
std::set<int> wrong_rows(const std::vector<Run>& runs) {
  constexpr double far = 8.0;  // medians
  std::map<int, int> missed;
  for (const Run& run : runs) {
    std::vector<double> errors;
    for (const auto& [row, error] : run.errors) errors.push_back(error);
    if (errors.empty()) continue;
    const double limit = far * median(errors);
    for (const auto& [row, error] : run.errors) missed[row] += error > limit;
  }
  std::set<int> wrong;
  for (const auto& [row, times] : missed)
    if (times == static_cast<int>(runs.size())) wrong.insert(row);
  return wrong;
}

struct Figures {
  double mean = 0.0, p95 = 0.0, p99 = 0.0, worst = 0.0;  // [mm]
};

Figures figures_of(const Run& run, const std::set<int>& wrong) {
  std::vector<double> errors;
  for (const auto& [row, error] : run.errors)
    if (!wrong.contains(row)) errors.push_back(1e3 * error);
  if (errors.empty()) return {};
  return {mean(errors), quantile(errors, 0.95), quantile(errors, 0.99), *std::ranges::max_element(errors)};
}

struct Regret {
  double mean = 1.0, p99 = 1.0, worst = 1.0;
  double sd = 0.0;         // of the regret of the mean, from the paired differences of the rows
  double foresight = 1.0;  // of the mean, over the set that other rows prefer: hindsight takes the luckiest of many
};

/// Sum of the errors of the rows that `accepts`, without wrong ones.
template <class Accepts>
double sum_of(const Run& run, const std::set<int>& wrong, Accepts accepts) {
  double sum = 0.0;
  for (const auto& [row, error] : run.errors)
    if (!wrong.contains(row) && accepts(row)) sum += error;
  return sum;
}

/// Over the set that is best on the other half of the held-out rows.
double regret_by_foresight(const Run& chosen, const std::vector<Run>& sets, const std::set<int>& wrong) {
  std::map<int, int> part;
  for (const auto& [row, error] : chosen.errors) part[row] = static_cast<int>(part.size()) % 2;
  double own = 0.0, other = 0.0;
  for (const int judged : {0, 1}) {
    const auto is_judged = [&](int row) { return part[row] == judged; };
    const auto decides = [&](int row) { return part[row] != judged; };
    const Run* preferred = nullptr;
    for (const Run& set : sets)
      if (!set.errors.empty() && (!preferred || sum_of(set, wrong, decides) < sum_of(*preferred, wrong, decides)))
        preferred = &set;
    if (!preferred) return 1.0;
    own += sum_of(chosen, wrong, is_judged), other += sum_of(*preferred, wrong, is_judged);
  }
  return own / other;
}

/// Standard deviation of the ratio of two means, from the differences of the rows.
double sd_of_ratio(const Run& chosen, const Run& best, const std::set<int>& wrong) {
  std::vector<double> differences, reference;
  for (const auto& [row, error] : chosen.errors)
    if (const auto other = best.errors.find(row); other != best.errors.end() && !wrong.contains(row))
      differences.push_back(error - other->second), reference.push_back(other->second);
  if (differences.size() < 2) return 0.0;
  return standard_deviation(differences) / std::sqrt(static_cast<double>(differences.size())) / mean(reference);
}

Regret regret_of(const Run& chosen, const Run& best, const std::set<int>& wrong) {
  const Figures of_chosen = figures_of(chosen, wrong), of_best = figures_of(best, wrong);
  return {of_chosen.mean / of_best.mean, of_chosen.p99 / of_best.p99, of_chosen.worst / of_best.worst,
          sd_of_ratio(chosen, best, wrong)};
}

/// Of a robot: by default options, and by whoever knows which terms made the data but not how large they are.
struct Regrets {
  Regret chosen;
  std::optional<Regret> truth;
  std::map<std::string, Regret> sets;  // of each fixed set
};

/// The one fixed set whose regrets over all halves of a robot are least: that of whoever knows the right terms.
std::vector<Regret> one_set_for_all(const std::vector<Regrets>& halves) {
  std::vector<Regret> least;
  const auto sum_of_means = [](const std::vector<Regret>& regrets) {
    double sum = 0.0;
    for (const Regret& regret : regrets) sum += regret.mean;
    return sum;
  };
  for (const auto& [name, first] : halves.front().sets) {
    std::vector<Regret> regrets;
    for (const Regrets& half : halves)
      if (const auto at = half.sets.find(name); at != half.sets.end()) regrets.push_back(at->second);
    if (regrets.size() == halves.size() && (least.empty() || sum_of_means(regrets) < sum_of_means(least)))
      least = regrets;
  }
  return least;
}

Regrets study_half(const NamedTask& named, int half, const Options& options) {
  CalibrationTask task = named.task;
  if (options.rows > 0 && task.data.rows() > options.rows)
    task.data = select(task.data,
                       random_split(static_cast<int>(task.data.rows()),
                                    static_cast<double>(options.rows) / static_cast<double>(task.data.rows()), Rng(99))
                           .holdout);
  task.data = with_half_held_out(task.data, half);
  std::vector<Run> runs{run(task, "auto", options.threads)};
  for (int i = 0; i < std::min<int>(options.sets, std::size(fixed_sets)); ++i)
    runs.push_back(run(task, fixed_sets[i], options.threads));
  const std::set<int> wrong = wrong_rows(runs);
  const Figures chosen = figures_of(runs.front(), wrong);
  const Run* best_run = &runs.front();
  for (std::size_t i = 1; i < runs.size(); ++i)
    if (!runs[i].errors.empty() &&
        (best_run == &runs.front() || figures_of(runs[i], wrong).mean < figures_of(*best_run, wrong).mean))
      best_run = &runs[i];
  const Figures best = figures_of(*best_run, wrong);
  const Figures geometry = runs.size() > 1 ? figures_of(runs[1], wrong) : chosen;
  Regret regret = regret_of(runs.front(), *best_run, wrong);
  if (runs.size() > 1) regret.foresight = regret_by_foresight(runs.front(), {runs.begin() + 1, runs.end()}, wrong);
  fmt::print(
      "{:<22} {} | {:7.4f} {:7.4f} {:7.4f} {:7.4f} | {:7.4f} | {:7.4f} {:7.4f} {:7.4f} {:7.4f} | {:6.3f} ± {:.3f}, "
      "{:6.3f}, "
      "{:6.3f} {:6.3f} | {:5.1f} s | {} | {}\n",
      named.name, half, chosen.mean, chosen.p95, chosen.p99, chosen.worst, geometry.mean, best.mean, best.p95, best.p99,
      best.worst, regret.mean, regret.sd, regret.foresight, regret.p99, regret.worst, runs.front().seconds,
      runs.front().model, best_run->model);
  if (options.reasons) fmt::print("{}", runs.front().reasons);
  if (options.reasons > 1)
    for (const Run& run : runs) {
      const Figures f = figures_of(run, wrong);
      fmt::print("    {:7.4f} {:7.4f} {:7.4f} {:7.4f}  {}\n", f.mean, f.p95, f.p99, f.worst, run.model);
    }
  std::fflush(stdout);
  Regrets regrets{.chosen = regret};
  for (std::size_t i = 1; i < runs.size(); ++i)
    if (!runs[i].errors.empty()) regrets.sets[fixed_sets[i - 1]] = regret_of(runs[i], *best_run, wrong);
  if (!named.truth.empty()) regrets.truth = regret_of(run(task, named.truth, options.threads), *best_run, wrong);
  return regrets;
}

/// Columns of figures of which medians and largest ones are printed.
struct RegretTable {
  std::vector<double> means, foresights, tails, worsts;
  int significant = 0;  // regrets of the mean above 1 by two standard deviations

  void add(const Regret& r) {
    means.push_back(r.mean), foresights.push_back(r.foresight), tails.push_back(r.p99), worsts.push_back(r.worst);
    significant += r.mean > 1.0 + 2.0 * r.sd;
  }
  void print(const char* of) const {
    if (means.empty()) return;
    fmt::print(
        "{}, {} halves: regret of the mean: median {:.3f}, worst {:.3f}, {} beyond chance (2 sd); over the set that "
        "other "
        "rows prefer: median {:.3f}, worst {:.3f}; of the 99 % point: median {:.3f}, worst {:.3f}; of the worst pose: "
        "{:.3f}\n",
        of, means.size(), median(means), *std::ranges::max_element(means), significant, median(foresights),
        *std::ranges::max_element(foresights), median(tails), *std::ranges::max_element(tails),
        *std::ranges::max_element(worsts));
  }
};

/// Rigid robots without any further error: what the default loses against geometry alone, at 200 unseen poses without
/// noise.
void study_rigid(const Options& options) {
  std::vector<double> ratios;
  std::map<std::string, int> models;
  for (int seed = 1; seed <= options.rigid; ++seed) {
    const RigidRobot robot = rigid_robot(seed);
    const auto error = [&](const char* model) {
      const auto c =
          calibrate_robot(robot.task, {.model = parse_model_choice(model).value(), .threads = options.threads}, Rng(1));
      if (std::string_view(model) == "auto") ++models[selected_model(c->model_selection)];
      return mean(point_errors(c->estimate.chain, robot.unseen));
    };
    const double chosen = error("auto");
    ratios.push_back(chosen / error("geometry"));
  }
  fmt::print("{} rigid robots of 40 poses: error over that of geometry alone: mean {:.3f}, worst {:.3f}; models:\n",
             options.rigid, mean(ratios), *std::ranges::max_element(ratios));
  for (const auto& [model, times] : models) fmt::print("  {} x {}\n", times, model);
}

void study(const Options& options) {
  if (options.rigid > 0) return study_rigid(options);
  const std::vector<NamedTask> tasks = named_tasks(options.only, options.simulated);
  if (tasks.empty())
    fmt::print("no set has \"{}\" in its name; those measured are in KINFER_DATA and KINFER_CASES\n", options.only);
  fmt::print(
      "{:<22} h | default: mean, 95 %, 99 %, worst [mm] | geometry | best fixed set | regret: mean ± sd, mean over "
      "the set that other rows prefer, 99 %, worst | time "
      "| chosen | best\n",
      "set");
  RegretTable chosen, one_set, chosen_where_known, truth;
  for (const NamedTask& named : tasks) {
    std::vector<Regrets> halves;
    for (int half = 1; half <= (named.name.starts_with("simulated") ? 1 : options.halves); ++half) {
      const Regrets& regrets = halves.emplace_back(study_half(named, half, options));
      chosen.add(regrets.chosen);
      if (regrets.truth) chosen_where_known.add(regrets.chosen), truth.add(*regrets.truth);
    }
    if (halves.size() > 1)
      for (const Regret& regret : one_set_for_all(halves)) one_set.add(regret);
  }
  chosen.print("default");
  one_set.print("the one fixed set that is best over all halves of a robot, picked with hindsight");
  chosen_where_known.print("default, where the terms that made the data are known");
  truth.print("exactly the terms that made the data");
}

}  // namespace
}  // namespace kinfer::study::regret_study

int kinfer::study::run_regret(int argc, char** argv) {
  regret_study::Options options;
  ArgumentParser app("Regret of the automatic choice of model terms, over fixed sets of terms");
  app.add_option("--only", options.only, "Sets whose names have this in them");
  app.add_option("--halves", options.halves, "Random halves of each measured set");
  app.add_option("--sets", options.sets, "Fixed sets of terms, at most 29");
  app.add_option("--rows", options.rows, "Rows of each set; 0: all");
  app.add_option("--simulated", options.simulated, "Simulated robots");
  app.add_option("--rigid", options.rigid, "Rigid robots against geometry alone, in place of all sets");
  app.add_option("--threads", options.threads, "0: all cores");
  app.add_option("--reasons", options.reasons, "1: why each term was taken or not; 2: figures of every set, too");
  if (const auto code = app.exit_code(argc, argv)) return *code;
  regret_study::study(options);
  return 0;
}
