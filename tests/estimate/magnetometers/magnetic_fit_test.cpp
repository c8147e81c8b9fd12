// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/magnetic_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/base/rng.hpp"
#include "kinfer/estimate/magnetometers/heading_scan.hpp"
#include "support/differences.hpp"
#include "support/random.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

constexpr IronPrior sound{.hard_iron = 0.3, .soft_iron = 2e-3, .misalignment = 1e-3};
const Vec3 earth(1.5, 20.5, -44.0);

/// A house that swings about the vertical and a boom on it that pitches; the boom's azimuth is wrong by `azimuth`.
struct House {
  MagneticRecording recording;
  std::vector<SubtreeRotation> rotations{{2, {}}};
  std::vector<Vec3> hard_iron;

  House(double azimuth, double iron, double noise, std::uint64_t seed = 1) {
    Rng rng(seed);
    recording.bins = 500;
    recording.strength = earth.norm();
    recording.sensors = {series(0, {1}, iron, rng), series(1, {1, 2}, iron, rng)};
    const Mat3 mounting[2] = {exp_so3(test::random_vector(rng)), exp_so3(test::random_vector(rng))};
    for (std::size_t t = 0; t < recording.bins; ++t) {
      const double time = 0.1 * static_cast<double>(t);
      const Mat3 house = rot_z(0.6 * std::sin(0.9 * time)), boom = house * rot_y(0.5 * std::sin(0.7 * time));
      const Mat3 believed = rot_z(-azimuth);  // what the recording's orientations lack
      rotations[0].axis.push_back(Vec3::UnitZ());
      for (std::size_t s = 0; s < 2; ++s) {
        const Mat3 truth = (s == 0 ? house : boom) * mounting[s];
        MagneticSeries& own = recording.sensors[s];
        own.root_R_sensor.push_back(s == 0 ? truth : Mat3(believed * truth));
        own.field.push_back(truth.transpose() * earth + hard_iron[s] + noise * test::random_vector(rng));
        own.is_valid.push_back(true);
      }
    }
  }

  MagneticSeries series(std::size_t sensor, std::vector<std::size_t> path, double iron, Rng& rng) {
    hard_iron.push_back(iron * test::random_vector(rng));
    return {.sensor = sensor, .path = std::move(path), .field = {}, .is_valid = {}, .root_R_sensor = {}};
  }

  MagneticFit fit(double information = 0.0) const {
    return *fit_magnetometers(recording, rotations, sound, MatrixXd::Constant(1, 1, information));
  }
};

double sd(const MagneticFit& fit) {
  return 1.0 / std::sqrt(fit.information(0, 0));
}

TEST(MagneticModel, DerivativesAgreeWithDifferences) {
  House house(0.3, 1.0, 0.1);
  house.rotations.push_back({1, std::vector<Vec3>(house.recording.bins, Vec3(0.6, 0.0, 0.8))});
  const MagneticModel model(house.recording, house.rotations);
  Rng rng(5);
  MagneticUnknowns x{.rotation = VectorXd::Constant(2, 0.4), .field = earth, .hard_iron = {}, .soft_iron = {}};
  for (int s = 0; s < 2; ++s) {
    x.hard_iron.push_back(test::random_vector(rng));
    x.soft_iron.push_back(0.1 * exp_so3(test::random_vector(rng)));
  }
  for (const std::size_t series : {0UL, 1UL}) {
    const MatrixXd numeric = testing::numeric_jacobian(
        [&](const VectorXd& step) { return model.predict(model.retract(x, step), series, 123).value; },
        VectorXd::Zero(model.unknowns()));
    const auto analytic = model.predict(x, series, 123).derivative;
    EXPECT_LT((analytic.leftCols(5) - numeric.leftCols(5)).norm(), 1e-6);
    EXPECT_LT((analytic.rightCols(12) - numeric.middleCols(model.first_iron(series), 12)).norm(), 1e-6);
    const Vec3 left = house.recording.sensors[series].field[123] - model.predict(x, series, 123).value;
    EXPECT_LT((model.residual(x, series, 123) - left).norm(), 1e-12);
  }
}

TEST(HeadingScan, FindsAnyRotationOfTheCircle) {
  for (const double azimuth : {0.1, 1.5, 3.1, -2.4}) {
    const House house(azimuth, 2.0, 0.1);
    const MagneticModel model(house.recording, house.rotations);
    const MagneticUnknowns found = scan_headings(model, MatrixXd::Zero(1, 1), 4.0);
    EXPECT_LT(std::abs(std::remainder(found.rotation[0] - azimuth, 2.0 * std::numbers::pi)), 0.2) << azimuth;
  }
}

TEST(MagneticFit, FindsHalfATurnToAMilliradian) {
  const House house(3.0, 0.2, 0.05);
  const MagneticFit fit = house.fit();
  EXPECT_NEAR(std::remainder(fit.unknowns.rotation[0] - 3.0, 2.0 * std::numbers::pi), 0.0, 4.0 * sd(fit));
  EXPECT_LT(sd(fit), 3e-3);
}

TEST(MagneticFit, FindsHowMuchIronTheSensorsCarry) {
  const House house(0.5, 4.0, 0.05);
  const MagneticFit fit = house.fit();
  EXPECT_GT(fit.iron.hard_iron, 2.0);
  EXPECT_NEAR(fit.unknowns.rotation[0], 0.5, 4.0 * sd(fit));
  EXPECT_LT((fit.unknowns.hard_iron[1] - house.hard_iron[1]).norm(), 0.5);
  EXPECT_LT(House(0.5, 0.1, 0.05).fit().iron.hard_iron, 0.6) << "sound magnetometers stay sound";
}

TEST(MagneticFit, AUnitOfItsOwnChangesNothingButTheUnit) {
  House house(0.5, 0.2, 0.05);
  const MagneticFit microtesla = house.fit();
  for (MagneticSeries& series : house.recording.sensors)
    for (Vec3& field : series.field) field *= 0.02;
  house.recording.strength *= 0.02;
  const auto unitless = fit_magnetometers(house.recording, house.rotations, {0.006, 2e-3, 1e-3}, MatrixXd::Zero(1, 1));
  ASSERT_TRUE(unitless);
  EXPECT_NEAR(unitless->unknowns.rotation[0], microtesla.unknowns.rotation[0], 1e-4);
}

TEST(MagneticFit, StandardDeviationsHoldWithSlowDisturbances) {
  double squares = 0.0;
  constexpr int runs = 24;
  for (int run = 0; run < runs; ++run) {
    House house(0.2, 0.2, 0.05, static_cast<std::uint64_t>(run) + 10);
    Rng rng(static_cast<std::uint64_t>(run) + 100);
    for (MagneticSeries& series : house.recording.sensors) {
      Vec3 slow = Vec3::Zero();
      for (Vec3& field : series.field) {
        slow = 0.95 * slow + 0.3 * test::random_vector(rng);  // sd 1, two seconds
        field += slow;
      }
    }
    const MagneticFit fit = house.fit();
    squares += std::pow((fit.unknowns.rotation[0] - 0.2) / sd(fit), 2) / runs;
  }
  EXPECT_GT(squares, 0.4);
  EXPECT_LT(squares, 2.0);
}

TEST(MagneticFit, InformationOfOthersIsUsedAndNotCountedTwice) {
  const House house(0.003, 0.2, 0.05);
  const MagneticFit alone = house.fit(), both = house.fit(alone.information(0, 0));
  EXPECT_NEAR(both.unknowns.rotation[0], 0.5 * alone.unknowns.rotation[0], 0.1 * sd(alone)) << "halfway to 0";
  EXPECT_NEAR(both.mean[0], alone.mean[0], 0.2 * sd(alone)) << "what the magnetometers say is the same";
  EXPECT_NEAR(both.information(0, 0) / alone.information(0, 0), 1.0, 0.3);
}

TEST(MagneticFit, ThereIsNoneWithoutMeasurements) {
  EXPECT_FALSE(fit_magnetometers({}, {}, sound, MatrixXd()));
}

}  // namespace
}  // namespace kinfer
