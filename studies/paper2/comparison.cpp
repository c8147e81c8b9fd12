// SPDX-License-Identifier: Apache-2.0
#include "comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "kinfer/base/parallel.hpp"

namespace kinfer::paper2 {
namespace {

template <class Value>
double median_over(const Trials& trials, Value value) {
  std::vector<double> values;
  for (const Trial& trial : trials.list) values.push_back(value(trial));
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

double or_infinite(int iterations) {
  return iterations < 0 ? std::numeric_limits<double>::infinity() : iterations;
}

std::string iterations_text(double median) {
  return std::isfinite(median) ? fmt::format("{:.0f}", median) : "not reached";
}

}  // namespace

std::vector<Trials> compare(const Scenario& scenario, const std::vector<Method>& methods, int seeds,
                            const Effort& effort, int threads) {
  std::vector<Trials> all;
  for (const Method method : methods) all.push_back({method, std::vector<Trial>(seeds)});
  std::vector<std::optional<Problem>> problems(seeds);
  std::vector<Earlier> earlier(seeds);
  parallel_for(seeds, threads, [&](std::size_t i) {
    const int seed = static_cast<int>(i) + 1;
    problems[i] = scenario.now(seed);
    earlier[i] = identify_before(scenario.before(seed), seed);
  });
  // Every run is one item, all seeds of a method after one another, so that the cores finish together.
  parallel_for(seeds * methods.size(), threads, [&](std::size_t item) {
    const std::size_t method = item / seeds, i = item % seeds;
    all[method].list[i] = run(methods[method], *problems[i], earlier[i], 1001 + static_cast<int>(i), effort);
  });
  return all;
}

double median_iterations(const Trials& trials) {
  const double median = median_over(trials, [](const Trial& t) { return or_infinite(t.iterations); });
  return std::isfinite(median) ? median : -1.0;
}

int hits_within(const Trials& trials, int iterations) {
  return static_cast<int>(std::count_if(trials.list.begin(), trials.list.end(), [&](const Trial& t) {
    return t.iterations >= 0 && t.iterations <= iterations;
  }));
}

TextTable comparison_table(const std::vector<Trials>& trials) {
  TextTable table{
      {"method", "hits", "within 404", "iterations", "to 5.55e-5 mm² sum", "evaluations", "search [s]", "training [s]",
       "held-out mean [mm]", "sd [mm]", "max [mm]", "predicted rms [mm]", "held-out rms [mm]"},
      {}};
  for (const Trials& t : trials) {
    const auto millimetres = [&](auto value) { return fmt::format("{:.4f}", 1e3 * median_over(t, value)); };
    const double predicted = median_over(t, [](const Trial& x) { return x.predicted_rms; });
    table.rows.push_back(
        {name(t.method), fmt::format("{}/{}", hits_within(t, std::numeric_limits<int>::max()), t.list.size()),
         fmt::format("{}", hits_within(t, 404)),
         iterations_text(median_over(t, [](const Trial& x) { return or_infinite(x.iterations); })),
         iterations_text(median_over(t, [](const Trial& x) { return or_infinite(x.iterations_to_sum); })),
         fmt::format("{:.0f}", median_over(t, [](const Trial& x) { return double(x.evaluations); })),
         fmt::format("{:.4f}", median_over(t, [](const Trial& x) { return x.seconds; })),
         fmt::format("{:.2f}", median_over(t, [](const Trial& x) { return x.training_seconds; })),
         millimetres([](const Trial& x) { return x.held_out.mean; }),
         millimetres([](const Trial& x) { return x.held_out.sd; }),
         millimetres([](const Trial& x) { return x.held_out.max; }),
         predicted > 0.0 ? fmt::format("{:.4f}", 1e3 * predicted) : "",
         millimetres([](const Trial& x) { return x.held_out.rms; })});
  }
  return table;
}

}  // namespace kinfer::paper2
