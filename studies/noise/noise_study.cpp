// SPDX-License-Identifier: Apache-2.0
// Tracker noise of 10 µm + 5 µm/m, 50 poses, paper 2's robot with its table 3 errors somewhere in the tracker's world:
// the error on 300 held-out poses, for 20 seeds of poses and noise, beside the one that the covariance predicts.
#include <fmt/core.h>

#include "kinfer/base/parallel.hpp"
#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/estimate/poses/bundle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "studies/studies.hpp"
#include "support/robots.hpp"

int kinfer::study::run_noise(int, char**) {
  using namespace kinfer;
  using namespace kinfer::calibrate;
  Chain nominal = test::er20(0.125);
  nominal.tool.xyz = Vec3(0.03, 0.02, 0.1);
  Chain truth = test::with_table3_errors(nominal);
  truth.base = Frame::from_pose(Pose::from_xyz_rpy({1.2, -2.5, 0.35}, {0.02, -0.03, 2.3}));
  const PoseSet test_poses = test::measured(truth, test::paper2_poses(300, test::noise_free), 99);

  constexpr int seeds = 20;
  struct Figures {
    double mean, rms, max, expected_rms;
  };
  std::vector<Figures> figures(seeds);
  parallel_for(seeds, 0, [&](std::size_t i) {
    const PoseSet data = test::measured(truth, test::paper2_poses(50, test::tracker), static_cast<int>(i) + 1);
    const Calibration c = calibrate_robot({nominal, {}, test::tracker, data}, {}, Rng(1)).value();
    const ErrorStatistics errors = error_statistics(point_errors(c.estimate.chain, test_poses));
    double squares = 0.0;
    for (int row = 0; row < test_poses.rows(); ++row)
      squares += predicted_covariance(c.estimate, test_poses.joints.col(row)).trace();
    figures[i] = {errors.mean, errors.rms, errors.max, std::sqrt(squares / static_cast<double>(test_poses.rows()))};
  });

  fmt::print("seed  mean [um]  rms [um]  max [um]  expected rms [um]  actual/expected\n");
  std::vector<double> means, ratios;
  for (int i = 0; i < seeds; ++i) {
    const Figures& f = figures[i];
    means.push_back(f.mean), ratios.push_back(f.rms / f.expected_rms);
    fmt::print("{:>4}  {:>9.2f}  {:>8.2f}  {:>8.2f}  {:>17.2f}  {:>15.3f}\n", i + 1, 1e6 * f.mean, 1e6 * f.rms,
               1e6 * f.max, 1e6 * f.expected_rms, ratios.back());
  }
  fmt::print("mean  {:>9.2f}  {:>46}  {:>15.3f}\n", 1e6 * mean(means), "", mean(ratios));
  return 0;
}
