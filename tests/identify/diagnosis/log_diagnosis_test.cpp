// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "identify/driven_machine.hpp"
#include "kinfer/base/angle.hpp"
#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/identify/diagnosis/diagnosis.hpp"
#include "kinfer/identify/diagnosis/mended_log.hpp"
#include "kinfer/measurement/ins/ins_screening.hpp"
#include "repeats.hpp"

namespace kinfer::identify {
namespace {

const InsRecording& sound_log() {
  static const InsRecording log = test::driven_arm(5, 5, Script::standard).recording;
  return log;
}

void negate(TriadColumns& triad) {
  transform(triad, -1.0, Mat3::Identity());
}

/// The sound log after `fault`, with its flags as a reader would set them.
template <class Fault>
InsRecording with(Fault fault) {
  InsRecording log = sound_log();
  fault(log);
  for (InsSensor& sensor : log.sensors) flag_faults(sensor);
  return log;
}

std::vector<FindingKind> kinds_of(const Result<LogDiagnosis>& diagnosis) {
  EXPECT_TRUE(diagnosis) << diagnosis.error().what;
  std::vector<FindingKind> kinds;
  if (diagnosis)
    for (const Finding& f : diagnosis->findings) kinds.push_back(f.kind);
  return kinds;
}

using Kinds = std::vector<FindingKind>;

/// Largest difference of an instrument from the sound log's, over all sensors and rows.
double difference(const InsRecording& log, TriadColumns InsSensor::*instrument) {
  double most = 0.0;
  for (std::size_t s = 0; s < log.sensors.size(); ++s)
    for (std::size_t row = 0; row < log.sensors[s].rows(); ++row)
      most =
          std::max(most, ((log.sensors[s].*instrument).at(row) - (sound_log().sensors[s].*instrument).at(row)).norm());
  return most;
}

TEST(LogDiagnosis, ASoundLogIsUsedAsItIs) {
  const auto diagnosis = diagnose_log(sound_log(), 1);
  EXPECT_EQ(kinds_of(diagnosis), Kinds{});
  EXPECT_FALSE(diagnosis->mended);
}

TEST(LogDiagnosis, UnitsAreToldAndConverted) {
  const auto log = with([](InsRecording& r) {
    for (InsSensor& s : r.sensors) {
      transform(s.acceleration, 1.0 / standard_gravity, Mat3::Identity());
      transform(s.angular_velocity, 1.0 / degree, Mat3::Identity());
      transform(s.field, 1e-3, Mat3::Identity());
    }
    for (double& t : r.loggers[0].time) t *= 1e3;
  });
  const auto diagnosis = diagnose_log(log, 1);
  EXPECT_EQ(kinds_of(diagnosis),
            (Kinds{FindingKind::force_unit, FindingKind::clock_unit, FindingKind::field_unit, FindingKind::rate_unit}));
  for (const Finding& f : diagnosis->findings) EXPECT_TRUE(f.applied);
  EXPECT_LT(difference(*diagnosis->mended, &InsSensor::acceleration), 1e-4);
  EXPECT_LT(difference(*diagnosis->mended, &InsSensor::angular_velocity), 1e-5);
  EXPECT_LT(difference(*diagnosis->mended, &InsSensor::field), 1e-3);
}

TEST(LogDiagnosis, IronThatTurnsWithAMagnetometerIsNoUnitOfTheRates) {
  for (const float iron : {30.0F, 60.0F, 120.0F}) {  // [µT]
    const auto log = with([iron](InsRecording& r) {
      for (std::size_t s = 0; s < r.sensors.size(); ++s)
        for (float& x : r.sensors[s].field.axis[s % 3]) x += iron;
    });
    EXPECT_THAT(kinds_of(diagnose_log(log, 1)), ::testing::Not(::testing::Contains(FindingKind::rate_unit))) << iron;
  }
}

TEST(LogDiagnosis, AUnitOfTimeThatTheFileStatesIsBelieved) {
  const auto slow = [](bool states_unit) {
    return with([states_unit](InsRecording& r) {
      for (double& t : r.loggers[0].time) t *= 100.0;
      r.loggers[0].states_unit = states_unit;
    });
  };
  EXPECT_EQ(kinds_of(diagnose_log(slow(true), 1)), Kinds{});
  EXPECT_THAT(kinds_of(diagnose_log(slow(false), 1)), ::testing::Contains(FindingKind::clock_unit));
}

TEST(LogDiagnosis, ANegatedInstrumentOfOneSensorIsToldByItsOtherInstrumentsAndItsNeighbours) {
  const auto reversed = diagnose_log(with([](InsRecording& r) { negate(r.sensors[3].angular_velocity); }), 1);
  EXPECT_EQ(kinds_of(reversed), Kinds{FindingKind::rate_sign});
  EXPECT_TRUE(reversed->findings[0].applied);
  EXPECT_LT(difference(*reversed->mended, &InsSensor::angular_velocity), 1e-6);
  const auto upside_down = diagnose_log(with([](InsRecording& r) { negate(r.sensors[2].acceleration); }), 1);
  EXPECT_EQ(kinds_of(upside_down), Kinds{FindingKind::force_sign});
  EXPECT_EQ(upside_down->findings[0].values.texts("sensors").front(), "ins2");
  EXPECT_LT(difference(*upside_down->mended, &InsSensor::acceleration), 1e-6);
}

TEST(LogDiagnosis, ALeftHandedSensorIsToldFromAReversedGyroscopeByItsNeighbours) {
  const auto diagnosis = diagnose_log(
      with([](InsRecording& r) {
        const Mat3 mirror = Vec3(1, -1, 1).asDiagonal();
        for (auto* triad : {&r.sensors[3].acceleration, &r.sensors[3].angular_velocity, &r.sensors[3].field})
          transform(*triad, 1.0, mirror);
      }),
      1);
  EXPECT_EQ(kinds_of(diagnosis), Kinds{FindingKind::left_handed});
}

TEST(LogDiagnosis, AllGyroscopesReversedMayAsWellBeLeftHandedSensors) {
  const auto diagnosis = diagnose_log(with([](InsRecording& r) {
                                        for (InsSensor& s : r.sensors) negate(s.angular_velocity);
                                      }),
                                      1);
  for (const Finding& f : diagnosis->findings) {
    EXPECT_EQ(f.kind, FindingKind::rate_sign);
    EXPECT_FALSE(f.applied) << "two cures, so the result is not certain";
    EXPECT_EQ(f.equivalents.size(), 1U);
  }
}

TEST(LogDiagnosis, ASensorThatOnlySlewsSharesTheReversedGyroscopesOfTheOthers) {
  for (const char* machine : test::repeats({"excavator", "robot6"})) {
    InsRecording log = test::driven_machine(machine, 8).recording;
    for (InsSensor& s : log.sensors) negate(s.angular_velocity), flag_faults(s);
    const auto kinds = kinds_of(diagnose_log(log, 2));
    EXPECT_EQ(std::ranges::count(kinds, FindingKind::force_sign), 0) << machine;
    EXPECT_EQ(std::ranges::count(kinds, FindingKind::rate_sign), std::ssize(kinds)) << machine;
  }
}

TEST(LogDiagnosis, BiasesThatPointUpByChanceAreNoEulerAngles) {
  const auto log = with([](InsRecording& r) {
    InsSensor& s = r.sensors[0];  // does not move
    const Vec3 up = s.acceleration.at(0).normalized(), rpy(std::atan2(up.y(), up.z()), -std::asin(up.x()), 0.0);
    for (std::size_t k = 0; k < 3; ++k)
      for (float& w : s.angular_velocity.axis[k]) w += static_cast<float>(rpy[static_cast<Eigen::Index>(k)]);
  });
  EXPECT_TRUE(diagnose_log(log, 1));
}

/// A level base at rest whose instruments warm up: both biases move alike, so that the rates seem to follow the tilt.
InsSensor warming_base(std::span<const double> time, double rate_bias, double force_bias, std::uint64_t seed) {
  constexpr double warming = 20.0;  // [s]
  Rng rng(seed);
  InsSensor base{.name = "base", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  for (const double t : time) {
    const double warm = 1.0 - std::exp(-(t - time.front()) / warming);
    const Vec3 force = Vec3(-warm * force_bias, warm * force_bias, standard_gravity) + 0.012 * normal_vector(rng),
               rate = Vec3(warm * rate_bias, warm * rate_bias, 0.0) + 1.2e-3 * normal_vector(rng);
    for (std::size_t k = 0; k < 3; ++k) {
      base.acceleration.axis[k].push_back(static_cast<float>(force[static_cast<Eigen::Index>(k)]));
      base.angular_velocity.axis[k].push_back(static_cast<float>(rate[static_cast<Eigen::Index>(k)]));
    }
  }
  base.faults.assign(time.size(), 0);
  return base;
}

TEST(LogDiagnosis, InstrumentsThatWarmUpHoldNoEulerAngles) {
  for (const double warm : {0.005, 0.01, 0.02})
    EXPECT_TRUE(diagnose_log(
        with([&](InsRecording& r) { r.sensors.push_back(warming_base(r.loggers[0].time, warm, 10.0 * warm, 1)); }), 1))
        << warm << " rad/s";
}

/// A bias turns a direction that stands still, in a smaller unit by less.
TEST(LogDiagnosis, ABiasOfASensorThatStandsStillIsNoOtherUnit) {
  for (const std::uint64_t seed : test::repeats({1U, 2U, 3U})) {
    const auto log = with([&](InsRecording& r) {
      Rng rng(seed);
      const Vec3 bias = 0.015 * normal_vector(rng).normalized();
      InsSensor& s = r.sensors[0];  // does not move
      for (std::size_t k = 0; k < 3; ++k)
        for (float& w : s.angular_velocity.axis[k])
          w += static_cast<float>(bias[static_cast<Eigen::Index>(k)] + 3.5e-3 * rng.normal());
    });
    EXPECT_EQ(kinds_of(diagnose_log(log, 1)), Kinds{});
  }
}

/// After a rest an upper carriage slews at a steady rate about the vertical: gravity shows nothing of it.
InsSensor slewing_carriage(std::span<const double> time, double slew, std::uint64_t seed) {
  constexpr double rest = 4.0;  // [s]
  Rng rng(seed);
  const Vec3 rate_bias = 2e-3 * normal_vector(rng), force_bias = 0.01 * normal_vector(rng);
  InsSensor carriage{.name = "carriage", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}};
  const auto push = [](TriadColumns& triad, const Vec3& v) {
    for (std::size_t k = 0; k < 3; ++k) triad.axis[k].push_back(static_cast<float>(v[static_cast<Eigen::Index>(k)]));
  };
  for (const double t : time) {
    const double since = std::max(0.0, t - time.front() - rest), rate = since > 0.0 ? slew : 0.0;
    const Mat3 carriage_R_world = exp_so3(Vec3(0.0, 0.0, -slew * since));
    push(carriage.acceleration,
         Vec3(-0.3 * rate * rate, 0.0, standard_gravity) + force_bias + 0.012 * normal_vector(rng));
    push(carriage.angular_velocity, Vec3(0.0, 0.0, rate) + rate_bias + 1.2e-3 * normal_vector(rng));
    push(carriage.field, carriage_R_world * Vec3(18.0, 5.0, -45.0) + 0.3 * normal_vector(rng));
  }
  carriage.faults.assign(time.size(), 0);
  return carriage;
}

TEST(LogDiagnosis, ASteadySlewIsNoOtherUnit) {
  for (const double slew : {0.02, 0.05, 0.1, 0.2})
    for (const bool has_field : {false, true})
      for (const std::uint64_t seed : test::repeats({1U, 2U, 3U}))
        EXPECT_EQ(kinds_of(diagnose_log(with([&](InsRecording& r) {
                                          r.sensors.push_back(slewing_carriage(r.loggers[0].time, slew, seed));
                                          if (!has_field) r.sensors.back().field = {};
                                        }),
                                        1)),
                  Kinds{})
            << slew << " rad/s, field " << has_field << ", seed " << seed;
}

TEST(LogDiagnosis, AllAccelerometersNegatedAreToldByMagnetometersAlone) {
  const auto negate_all = [](InsRecording& r) {
    for (InsSensor& s : r.sensors) negate(s.acceleration);
  };
  const auto diagnosis = diagnose_log(with(negate_all), 1);
  EXPECT_EQ(kinds_of(diagnosis), Kinds{FindingKind::force_sign});
  EXPECT_TRUE(questions_result(diagnosis->findings[0])) << "the southern hemisphere looks the same";
  const auto without = diagnose_log(with([&](InsRecording& r) {
                                      negate_all(r);
                                      for (InsSensor& s : r.sensors) s.field = {};
                                    }),
                                    1);
  EXPECT_EQ(kinds_of(without), Kinds{}) << "an exact symmetry";
}

TEST(LogDiagnosis, SwappedAxesOfOneInstrumentAreMapped) {
  Mat3 axes = Mat3::Zero();
  axes(0, 1) = 1.0, axes(1, 0) = -1.0, axes(2, 2) = 1.0;
  const auto gyroscope =
      diagnose_log(with([&](InsRecording& r) { transform(r.sensors[4].angular_velocity, 1.0, axes); }), 1);
  EXPECT_EQ(kinds_of(gyroscope), Kinds{FindingKind::instrument_axes});
  EXPECT_EQ(gyroscope->findings[0].values.text("instrument"), "gyroscope");
  EXPECT_EQ(gyroscope->findings[0].values.text("axes"), "-y, x, z");
  EXPECT_LT(difference(*gyroscope->mended, &InsSensor::angular_velocity), 1e-6);
  const auto accelerometer =
      diagnose_log(with([&](InsRecording& r) { transform(r.sensors[4].acceleration, 1.0, axes); }), 1);
  EXPECT_EQ(kinds_of(accelerometer), Kinds{FindingKind::instrument_axes});
  EXPECT_EQ(accelerometer->findings[0].values.text("instrument"), "accelerometer");
  EXPECT_LT(difference(*accelerometer->mended, &InsSensor::acceleration), 1e-6);
}

TEST(LogDiagnosis, AnAccelerometerOutOfStepIsShifted) {
  const auto diagnosis = diagnose_log(with([](InsRecording& r) {
                                        for (auto& axis : r.sensors[4].acceleration.axis)
                                          for (std::size_t k = axis.size(); k-- > 5;) axis[k] = axis[k - 5];
                                      }),
                                      1);
  EXPECT_EQ(kinds_of(diagnosis), Kinds{FindingKind::instruments_out_of_step});
  EXPECT_NEAR(diagnosis->findings[0].values.number("lag"), 0.05, 0.005);
}

TEST(LogDiagnosis, AnEngineThatShakesABaseAtRestIsNoFaultOfItsInstruments) {
  for (const double frequency : {22.0, 27.0, 31.0}) {
    const auto diagnosis =
        diagnose_log(with([&](InsRecording& r) {
                       const Vec3 force(1.2, -0.7, 1.5), rate(0.02, 0.01, -0.015);
                       InsSensor& base = r.sensors[0];
                       const auto time = r.time(base);
                       for (std::size_t row = 0; row < base.rows(); ++row) {
                         const double angle = 2.0 * std::numbers::pi * frequency * time[row];
                         for (std::size_t k = 0; k < 3; ++k) {
                           const auto axis = static_cast<Eigen::Index>(k);
                           base.acceleration.axis[k][row] += static_cast<float>(std::sin(angle) * force[axis]);
                           base.angular_velocity.axis[k][row] += static_cast<float>(std::sin(angle + 1.0) * rate[axis]);
                         }
                       }
                     }),
                     1);
    EXPECT_EQ(kinds_of(diagnosis), Kinds{}) << frequency;
  }
}

TEST(LogDiagnosis, RowsThatNobodyMeasuredAreRemoved) {
  const auto resample = [](bool linearly) {
    return with([linearly](InsRecording& r) {
      for (InsSensor& s : r.sensors)
        for (auto* triad : {&s.acceleration, &s.angular_velocity})
          for (auto& axis : triad->axis)
            for (std::size_t k = 1; k + 1 < axis.size(); k += 2)
              axis[k] = linearly ? 0.5F * (axis[k - 1] + axis[k + 1]) : axis[k - 1];
    });
  };
  for (const bool linearly : {false, true}) {
    const auto diagnosis = diagnose_log(resample(linearly), 1);
    const auto kinds = kinds_of(diagnosis);
    EXPECT_EQ(kinds, Kinds(2 * sound_log().sensors.size(),
                           linearly ? FindingKind::interpolated_rows : FindingKind::repeated_rows));
    EXPECT_NEAR(static_cast<double>(count(diagnosis->mended->sensors[2], acceleration_missing)),
                0.5 * static_cast<double>(sound_log().sensors[2].rows()), 20.0);
  }
}

TEST(LogDiagnosis, WhatCannotBeMendedIsRefusedByName) {
  const auto free = with([](InsRecording& r) {
    for (auto& axis : r.sensors[1].acceleration.axis)
      for (std::size_t k = 0; k < axis.size(); ++k) axis[k] = 0.02F * static_cast<float>(k % 3);
  });
  EXPECT_NE(diagnose_log(free, 1).error().what.find("ins1_ax, ins1_ay, ins1_az hold no gravity"), std::string::npos);
}

TEST(LogDiagnosis, AFaultThatWasCuredDoesNotSpoilTheChain) {
  test::DrivenMachine drive = test::driven_arm(5, 4);
  for (InsSensor& s : drive.recording.sensors) transform(s.angular_velocity, 1.0 / degree, Mat3::Identity());
  negate(drive.recording.sensors[2].acceleration);
  for (InsSensor& s : drive.recording.sensors) flag_faults(s);
  const Identification found = test::identified(drive.recording);
  EXPECT_LT(test::worst_line_error(found.joints, drive.truth), 0.03);
  EXPECT_NE(found.usability, Usability::do_not_use);
  EXPECT_GE(found.findings.size(), 2U);
}

TEST(LogDiagnosis, IsTheSameForAnyNumberOfThreads) {
  const auto log = with([](InsRecording& r) { negate(r.sensors[3].angular_velocity); });
  const auto one = diagnose_log(log, 1), two = diagnose_log(log, 2);
  ASSERT_EQ(one->findings.size(), two->findings.size());
  EXPECT_EQ(one->findings[0].values, two->findings[0].values);
}

}  // namespace
}  // namespace kinfer::identify
