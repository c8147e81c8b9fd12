// SPDX-License-Identifier: Apache-2.0
// Regret of the automatic choice of model terms: held-out errors of the default over those of the best fixed set of
// terms, on halves of the rows that were never fitted.
//
//   ./dev study regret [--only TEXT] [--halves 5] [--sets 26] [--rows 0 (all)] [--simulated 30] [--threads 0]
//   [--reasons 0 (2: figures of every set)]
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/measurement/split.hpp"
#include "kinfer/words/calibration/model.hpp"
#include "studies/regret/data_sets.hpp"
#include "studies/studies.hpp"

namespace kinfer::study::regret_study {
using namespace calibrate;
namespace {

struct Options {
  std::string only;
  int halves = 5, sets = 26, rows = 0, simulated = 30, threads = 0, reasons = 0;
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
                                      "gains+coupling+gravity+torques+gear+spectrum+backlash+temperature"};

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
};

Regret regret_of(const Figures& chosen, const Figures& best) {
  return {chosen.mean / best.mean, chosen.p99 / best.p99, chosen.worst / best.worst};
}

/// Of a robot: by default options, and by whoever knows which terms made the data but not how large they are.
struct Regrets {
  Regret chosen;
  std::optional<Regret> truth;
};

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
  Figures best;
  std::string best_name;
  for (std::size_t i = 1; i < runs.size(); ++i)
    if (const Figures f = figures_of(runs[i], wrong);
        !runs[i].errors.empty() && (best_name.empty() || f.mean < best.mean))
      best = f, best_name = runs[i].model;
  const Figures geometry = runs.size() > 1 ? figures_of(runs[1], wrong) : chosen;
  if (best_name.empty()) best = chosen;
  const Regret regret = regret_of(chosen, best);
  fmt::print(
      "{:<22} {} | {:7.4f} {:7.4f} {:7.4f} {:7.4f} | {:7.4f} | {:7.4f} {:7.4f} {:7.4f} {:7.4f} | {:6.3f} {:6.3f} "
      "{:6.3f} | {:5.1f} s | {} | {}\n",
      named.name, half, chosen.mean, chosen.p95, chosen.p99, chosen.worst, geometry.mean, best.mean, best.p95, best.p99,
      best.worst, regret.mean, regret.p99, regret.worst, runs.front().seconds, runs.front().model, best_name);
  if (options.reasons) fmt::print("{}", runs.front().reasons);
  if (options.reasons > 1)
    for (const Run& run : runs) {
      const Figures f = figures_of(run, wrong);
      fmt::print("    {:7.4f} {:7.4f} {:7.4f} {:7.4f}  {}\n", f.mean, f.p95, f.p99, f.worst, run.model);
    }
  std::fflush(stdout);
  if (named.truth.empty()) return {regret, std::nullopt};
  return {regret, regret_of(figures_of(run(task, named.truth, options.threads), wrong), best)};
}

/// Columns of figures of which medians and largest ones are printed.
struct RegretTable {
  std::vector<double> means, tails, worsts;

  void add(const Regret& r) { means.push_back(r.mean), tails.push_back(r.p99), worsts.push_back(r.worst); }
  void print(const char* of) const {
    if (means.empty()) return;
    fmt::print(
        "{}, {} halves: regret of the mean: median {:.3f}, worst {:.3f}; of the 99 % point: worst {:.3f}; of the worst "
        "pose: {:.3f}\n",
        of, means.size(), median(means), *std::ranges::max_element(means), *std::ranges::max_element(tails),
        *std::ranges::max_element(worsts));
  }
};

void study(const Options& options) {
  fmt::print(
      "{:<22} h | default: mean, 95 %, 99 %, worst [mm] | geometry | best fixed set | regret: mean, 99 %, worst | time "
      "| chosen | best\n",
      "set");
  RegretTable chosen, chosen_where_known, truth;
  for (const NamedTask& named : named_tasks(options.only, options.simulated))
    for (int half = 1; half <= (named.name.starts_with("simulated") ? 1 : options.halves); ++half) {
      const Regrets regrets = study_half(named, half, options);
      chosen.add(regrets.chosen);
      if (regrets.truth) chosen_where_known.add(regrets.chosen), truth.add(*regrets.truth);
    }
  chosen.print("default");
  chosen_where_known.print("default, where the terms that made the data are known");
  truth.print("exactly the terms that made the data");
}

}  // namespace
}  // namespace kinfer::study::regret_study

int kinfer::study::run_regret(int argc, char** argv) {
  regret_study::Options options;
  const std::map<std::string, int*> counts{{"--halves", &options.halves},   {"--sets", &options.sets},
                                           {"--rows", &options.rows},       {"--simulated", &options.simulated},
                                           {"--threads", &options.threads}, {"--reasons", &options.reasons}};
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--only") options.only = argv[i + 1];
    if (const auto count = counts.find(argv[i]); count != counts.end()) *count->second = std::atoi(argv[i + 1]);
  }
  regret_study::study(options);
  return 0;
}
