// SPDX-License-Identifier: Apache-2.0
// The filters against optical ground truth and encoders, on public data that is not part of the project (KINFER_DATA).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "kinfer/base/angle.hpp"
#include "kinfer/inertial/filters/orientation.hpp"
#include "support/measured_trial.hpp"
#include "support/orientation_error.hpp"

namespace kinfer {
namespace {

namespace fs = std::filesystem;
using testing::aligned_error;
using testing::HeadingOffset;
using testing::MeasuredTrial;
using testing::orientation_error;
using testing::OrientationError;
using testing::read_trial;

const char* data_folder() {
  return std::getenv("KINFER_DATA");
}

OrientationError mean_over_broad(const FilterOptions& options, HeadingOffset offset) {
  OrientationError mean;
  double n = 0.0;
  for (const auto& folder : fs::directory_iterator(fs::path(data_folder()) / "broad")) {
    const MeasuredTrial trial = testing::read_broad(folder.path());
    const auto q = estimate_orientations(trial.recording.sensors[0], trial.recording.loggers[0].time, options);
    const OrientationError e = orientation_error(q, trial.truth, trial.moves, offset);
    mean.total += e.total / degree, mean.heading += e.heading / degree, mean.inclination += e.inclination / degree;
    n += 1.0;
  }
  mean.total /= n, mean.heading /= n, mean.inclination /= n;
  return mean;
}

TEST(Broad, TheOnlineFilterIsBetterThanTheBestKnownOne) {
  if (!data_folder()) GTEST_SKIP() << "KINFER_DATA is not set";
  const OrientationError nine = mean_over_broad(KinferFilterOptions{}, HeadingOffset::none);
  EXPECT_LT(nine.total, 2.0) << "VQF: 2.33";
  EXPECT_LT(nine.inclination, 0.70) << "VQF: 0.74";
  const FilterOptions six = without_magnetometer(KinferFilterOptions{});
  const OrientationError blind = mean_over_broad(six, HeadingOffset::best_constant);
  EXPECT_LT(blind.inclination, 0.71) << "VQF: 0.72";
  EXPECT_LT(blind.heading, 1.2) << "VQF: 2.21";
}

TEST(Broad, TheSmootherIsBetterThanTheBestKnownOne) {
  if (!data_folder()) GTEST_SKIP() << "KINFER_DATA is not set";
  const OrientationError nine = mean_over_broad(KinferOfflineOptions{}, HeadingOffset::none);
  EXPECT_LT(nine.total, 1.8) << "VQF: 2.25";
  EXPECT_LT(nine.inclination, 0.59) << "VQF: 0.60";
  const FilterOptions six = without_magnetometer(KinferOfflineOptions{});
  EXPECT_LT(mean_over_broad(six, HeadingOffset::best_constant).heading, 1.1) << "VQF: 2.20";
}

TEST(Broad, ThePapersFilterIsAccurateToAFewDegrees) {
  if (!data_folder()) GTEST_SKIP() << "KINFER_DATA is not set";
  const OrientationError e = mean_over_broad(PaperEkfOptions{}, HeadingOffset::none);
  EXPECT_LT(e.total, 7.0);
  EXPECT_GT(e.total, mean_over_broad(KinferFilterOptions{}, HeadingOffset::none).total);
}

TEST(Ur5, TheForearmsOrientationIsRightTo06Degrees) {
  if (!data_folder()) GTEST_SKIP() << "KINFER_DATA is not set";
  const fs::path folder = fs::path(data_folder()) / "ur5_openaxes";
  for (const FilterOptions& options : {FilterOptions(KinferFilterOptions{}), FilterOptions(KinferOfflineOptions{})}) {
    double mean = 0.0;
    for (const char* run : {"circle-150", "circle-250", "triangle-150"}) {
      const MeasuredTrial trial =
          read_trial(folder / (std::string(run) + "_imu.csv"), folder / (std::string(run) + "_truth.csv"), "radius_");
      const auto q = estimate_orientations(trial.recording.sensors[0], trial.recording.loggers[0].time, options);
      mean += aligned_error(q, trial.truth) / degree / 3.0;
    }
    EXPECT_LT(mean, 0.6);
  }
}

}  // namespace
}  // namespace kinfer
