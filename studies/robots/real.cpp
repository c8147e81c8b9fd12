// SPDX-License-Identifier: Apache-2.0
#include "real.hpp"

#include <limits>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/calibrate/validation/validation_errors.hpp"
#include "kinfer/deploy/verify.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "studies/support/files.hpp"
#include "studies/support/table.hpp"

namespace kinfer::study::robots_study {
using namespace calibrate;
using namespace deploy;
namespace {

constexpr double no_target = std::numeric_limits<double>::quiet_NaN();
constexpr int halves = 5;

Calibration on_half(const Chain& chain, const PoseSet& data, int seed, const ModelChoice& model) {
  return calibrate_robot({chain, {}, std::nullopt, data}, {.holdout = HeldOutFraction{0.5}, .model = model}, Rng(seed))
      .value();
}

struct Halves {
  double mean = 0.0, worst = 0.0, largest_worst = 0.0, before = 0.0;  // [mm], means over the halves
  double mean_of_all = 0.0, worst_of_all = 0.0;                       // gross errors included
  std::size_t wrong = 0;                                              // excluded rows, all halves together
  std::string model;
};

Halves five_halves(const Chain& chain, const PoseSet& data, const ModelChoice& model = AutomaticModel{}) {
  Halves sum;
  for (int seed = 1; seed <= halves; ++seed) {
    const Calibration c = on_half(chain, data, seed, model);
    sum.mean += 1e3 / halves * c.after.position.holdout.mean;
    sum.worst += 1e3 / halves * c.after.position.holdout.max;
    sum.largest_worst = std::max(sum.largest_worst, 1e3 * c.after.position.holdout.max);
    sum.mean_of_all += 1e3 / halves * c.after.position.holdout_all_rows.mean;
    sum.worst_of_all += 1e3 / halves * c.after.position.holdout_all_rows.max;
    sum.wrong += c.gross_error_rows.size();
    sum.before += 1e3 / halves * c.before.position.holdout.mean;
    sum.model += (seed > 1 ? "; " : "") + selected_model(c.model_selection);
  }
  return sum;
}

void print_halves(const std::string& name, double target, const Halves& h) {
  print_row(name, target, h.mean,
            fmt::format("worst {:.3f} (mean), {:.3f} (largest); before {:.3f}; with {} gross errors of the five halves "
                        "{:.4f}, worst {:.3f}",
                        h.worst, h.largest_worst, h.before, h.wrong, h.mean_of_all, h.worst_of_all));
}

void ur10(const std::string& folder) {
  const Chain chain = ur10_chain();
  const PoseSet b = ur10_series(folder, "Series_B_measurements_joint_configurations.csv", chain),
                c = ur10_series(folder, "Series_C_measurements_random_poses.csv", chain);
  print_halves("UR10 B, geometry", no_target, five_halves(chain, b, FixedModel{}));
  const Halves chosen_b = five_halves(chain, b);
  print_halves("UR10 B, selected model", 0.345, chosen_b);
  fmt::print("      {}\n", chosen_b.model);
  print_halves("UR10 C, geometry", no_target, five_halves(chain, c, FixedModel{}));
  const Halves chosen_c = five_halves(chain, c);
  print_halves("UR10 C, selected model", 0.435, chosen_c);
  fmt::print("      {}\n", chosen_c.model);
  for (const ModelChoice& model : {ModelChoice{FixedModel{}}, ModelChoice{AutomaticModel{}}}) {
    const Calibration all = calibrate_robot({chain, {}, std::nullopt, b}, {.model = model}, Rng(1)).value();
    const Verification there = verify(all.estimate.chain, {}, std::nullopt, c).value();
    print_row("UR10 fitted on B, tried on C with base and tool refitted", no_target, 1e3 * there.frames_refitted.mean,
              selected_model(all.model_selection));
  }
}

void mukca(const std::string& folder) {
  const Chain chain = mukca_chain(folder);
  const auto tried = [&](const std::string& arm, const std::vector<std::string>& fitted,
                         const std::vector<std::string>& held_out, double target) {
    const PoseSet train = mukca_rows(folder, arm, fitted, chain), test = mukca_rows(folder, arm, held_out, chain);
    const Calibration c = calibrate_robot({chain, {}, std::nullopt, train}, {}, Rng(1)).value();
    const auto consistency = [&](const Chain& model) {
      const DataWithFixtures there = with_fixtures(model, test).value();
      return 1e3 *
             mean(position_errors_of_fit(*primary_measurement_kind(there.data), there.chain, PoseSet{}, there.data));
    };
    print_row("MUKCa " + arm + ", ball centres at unseen tool positions", target, consistency(c.estimate.chain),
              fmt::format("nominal {:.2f}; {}; {} rows left out", consistency(chain), selected_model(c.model_selection),
                          c.estimate.outliers.size()));
  };
  tried("panda_1", {"back-high", "right"}, {"front"}, 0.70);
  tried("panda_2", {"back_left", "front_center", "front_right", "mid-high", "mid_right"},
        {"front_left", "back_right", "high", "mid_left"}, 0.50);
}

}  // namespace

void real_robots(const std::string& folder, const std::string& only) {
  print_head("Real robots, held out [mm]");
  const auto wanted = [&](const char* name) { return only.empty() || only == name; };
  if (wanted("mukca")) mukca(folder);
  if (wanted("positioner")) {
    const Chain chain = positioner_chain();
    const Halves h = five_halves(chain, positioner_rows(folder, chain));
    print_halves("positioner, five halves", 1.74, h);
    fmt::print("      {}\n", h.model);
  }
  if (wanted("fr3")) {
    const Chain chain = fr3_chain();
    const Halves h = five_halves(chain, fr3_rows(folder, chain));
    print_halves("FR3, camera origin, five halves", 1.35, h);
    fmt::print("      {}\n", h.model);
  }
  if (wanted("ur10")) ur10(folder);
}

}  // namespace kinfer::study::robots_study
