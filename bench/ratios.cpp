// SPDX-License-Identifier: Apache-2.0
#include "ratios.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kinfer/kinematics/batch/kernel_interface.hpp"

namespace kinfer::bench {
namespace {

/// Medians of a benchmark's repetitions; the fastest repetition for wall-clock times.
struct Measured {
  double seconds = 0.0;  ///< of an iteration
  double items = 0.0;    ///< a second
  double bytes = 0.0;    ///< a second
};

class MedianReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const std::string name = run.run_name.str();
      if (run.error_occurred) fmt::print(stderr, "{}: {}\n", name, run.error_message);
      const bool is_wall_clock = name.find("/real_time") != std::string::npos;
      if (run.aggregate_name == (is_wall_clock ? "fastest" : "median")) {
        Measured& m = medians[name];
        m.seconds = (is_wall_clock ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime()) /
                    benchmark::GetTimeUnitMultiplier(run.time_unit);
        if (const auto found = run.counters.find("items_per_second"); found != run.counters.end())
          m.items = found->second;
        if (const auto found = run.counters.find("bytes_per_second"); found != run.counters.end())
          m.bytes = found->second;
      }
    }
  }

  std::map<std::string, Measured> medians;
};

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

constexpr int multiply_adds_a_pose = 66;  // of ER20 with the target on its last axis (docs/development/performance.md)

class Table {
 public:
  explicit Table(const std::map<std::string, Measured>& medians) : medians_(medians) {
    fmt::print("\n{:<44} {:>14} {:>16} {:>14} {:>9} {:>9}\n", "what", "kinfer", "peer", "", "ratio", "required");
  }

  /// Ratio of items a second.
  void items(const std::string& what, const std::string& mine, const std::string& peer, const std::string& peer_name,
             double required) const {
    const auto a = find(mine), b = find(peer);
    if (!a || !b) return;
    line(what, fmt::format("{:.1f} M/s", 1e-6 * a->items), peer_name, fmt::format("{:.2f} M/s", 1e-6 * b->items),
         a->items / b->items, required);
  }

  /// Ratio of times.
  void times(const std::string& what, const std::string& mine, const std::string& peer, const std::string& peer_name,
             double required) const {
    const auto a = find(mine), b = find(peer);
    if (!a || !b) return;
    line(what, duration(a->seconds), peer_name, duration(b->seconds), b->seconds / a->seconds, required);
  }

  void share_of_bound(const std::string& kernels, double required) const {
    const auto a = find("population_double/" + kernels), peak = find("fma_peak/" + kernels);
    if (!a || !peak) return;
    const double bound = peak->items / multiply_adds_a_pose;
    line("population fitness, double, " + kernels, fmt::format("{:.1f} M/s", 1e-6 * a->items), "FMA bound",
         fmt::format("{:.1f} M/s", 1e-6 * bound), a->items / bound, required);
  }

  void figure(const std::string& what, const std::string& mine, const std::string& required) const {
    if (const auto a = find(mine))
      fmt::print("{:<44} {:>14} {:>41} {:>9}\n", what,
                 a->bytes > 0.0 ? fmt::format("{:.0f} MB/s", 1e-6 * a->bytes) : duration(a->seconds), "", required);
  }

 private:
  std::optional<Measured> find(const std::string& name) const {
    for (const auto& [key, value] : medians_)
      if (key == name || key.starts_with(name + "/iterations") || key.starts_with(name + "/repeats") ||
          key.starts_with(name + "/real_time"))
        return value;
    return std::nullopt;
  }
  static std::string duration(double seconds) {
    if (seconds < 1e-3) return fmt::format("{:.1f} us", 1e6 * seconds);
    return seconds < 1.0 ? fmt::format("{:.2f} ms", 1e3 * seconds) : fmt::format("{:.2f} s", seconds);
  }
  static void line(const std::string& what, const std::string& mine, const std::string& peer_name,
                   const std::string& peer, double ratio, double required) {
    fmt::print("{:<44} {:>14} {:>16} {:>14} {:>9.2f} {:>9}\n", what, mine, peer_name, peer, ratio,
               required > 0.0 ? fmt::format(">= {:g}", required) : "");
  }

  const std::map<std::string, Measured>& medians_;
};

void print(const std::map<std::string, Measured>& medians) {
  const Table table(medians);
  const batch::KernelList list = batch::runnable_kernels();
  for (int i = 0; i < list.count; ++i) {
    const std::string k = list.kernels[i]->name;
    const bool required = list.kernels[i]->lanes > 2;  // the portable kernels have no required figure
    table.items("population 200 x 50, double, " + k, "population_double/" + k, "naive_fitness", "naive Eigen",
                required ? 45 : 0);
    table.items("population 200 x 50, float, " + k, "population_float/" + k, "naive_fitness", "naive Eigen",
                required ? 90 : 0);
    table.items("one candidate, 50 poses, " + k, "errors/" + k, "naive_fitness", "naive Eigen", required ? 35 : 0);
    table.items("population 200 x 50, double, " + k, "population_double/" + k, "kdl_position", "Orocos KDL",
                required ? 80 : 0);
    table.items("residual + 24 columns, " + k, "jacobian/" + k, "ceres_jets", "Ceres Jets", required ? 18 : 0);
    table.items("residual + normal equations, " + k, "normal_equations/" + k, "ceres_jets", "Ceres Jets", 0);
    table.items("any chain, pose + 24 columns, " + k, "yielding_poses/" + k, "yielding_poses_one_by_one", "one by one",
                0);
    table.share_of_bound(k, 0.65);
  }
  table.times("cold fit of paper 2's case", "cold_fit", "ceres_cold_fit", "Ceres autodiff", 15);
  table.times("PSO 404 x 200 x 50", "kinfer_pso", "by_pagmo/pso", "pagmo PSO", 40);
  table.times("PSO 404 x 200 x 50", "kinfer_pso", "by_pagmo/cmaes", "pagmo CMA-ES", 0);
  table.times("MAP fit, 500 poses x 34 parameters", "kinfer_fit", "ceres_fit", "Ceres autodiff", 0);
  table.times("inverse kinematics, 500 random poses", "reach_full_poses", "kdl_inverse_with_restarts", "KDL, restarts",
              15);
  table.times("1000 bootstrap refits, 1 -> 2 threads", "bootstrap_1000/2", "bootstrap_1000/1", "1 thread", 1.85);
  table.figure("1000 bootstrap refits, two threads", "bootstrap_1000/2", "<= 2 s");
  table.figure("cold fit of paper 2's case", "cold_fit", "<= 50 us");
  table.figure("kinfer --version", "start_up", "<= 20 ms");
  table.figure("reading a recording of 60 MB", "read_recording", ">= 150");
  table.figure("orientation filter, 120 s at 200 Hz", "filter_a_row/kinfer/200", "");
}

/// Default options, which options of the user override.
std::vector<char*> with_defaults(int argc, char** argv, std::vector<std::string>& storage) {
  storage = {argv[0], "--benchmark_repetitions=15", "--benchmark_min_time=0.01",
             "--benchmark_enable_random_interleaving=true", "--benchmark_report_aggregates_only=true"};
  for (int i = 1; i < argc; ++i) storage.emplace_back(argv[i]);
  std::vector<char*> list;
  for (std::string& argument : storage) list.push_back(argument.data());
  return list;
}

}  // namespace

int run_and_print_ratios(int argc, char** argv) {
  std::vector<std::string> storage;
  std::vector<char*> arguments = with_defaults(argc, argv, storage);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
  benchmark::AddCustomContext("processor", processor());
  benchmark::AddCustomContext("build", KINFER_BUILD);
  benchmark::AddCustomContext("kernels", batch::best_kernels().name);
  MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  fmt::print("{}; {}; medians of CPU time on one thread; 1 -> 2 threads: fastest wall-clock time\n", processor(),
             KINFER_BUILD);
  print(reporter.medians);
  return 0;
}

}  // namespace kinfer::bench
