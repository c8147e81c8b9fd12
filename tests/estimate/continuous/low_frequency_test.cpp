// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/continuous/low_frequency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinfer/estimate/continuous/model/interval_motion.hpp"

namespace kinfer {
namespace {

using Eigen::Index;

double wave(double frequency, double time) {
  return std::sin(2.0 * std::numbers::pi * frequency * time);
}

MatrixXd spline_dimension(const SplineGrid& grid, double frequency) {
  std::vector<double> time;
  for (double t = grid.begin; t < grid.end(); t += 0.01) time.push_back(t);
  MatrixXd values(static_cast<Index>(time.size()), 1);
  for (std::size_t i = 0; i < time.size(); ++i) values(static_cast<Index>(i), 0) = wave(frequency, time[i]);
  return fit_spline(grid, time, values);
}

TEST(LowFrequency, AttenuatesTheCutoffToSeventyPercentAndPassesSlowWaves) {
  const SplineGrid grid{0.0, 0.025, 400};
  for (const auto& [frequency, amplitude] : {std::pair{2.0, std::numbers::sqrt2 / 2.0}, {0.2, 0.9965}, {6.0, 0.0442}}) {
    const MatrixXd slow = low_frequency_motion(spline_dimension(grid, frequency), grid, 2.0);
    for (const double t : {4.0, 5.03, 6.1})
      EXPECT_NEAR(spline_value(grid, slow, t)[0], amplitude * wave(frequency, t), 2e-3) << frequency << " Hz at " << t;
  }
}

/// A root that rotates and vibrates, and a body on a revolute joint.
struct Machine {
  InsProblem problem;
  InsUnknowns x;
  InsRecording recording;

  Machine() {
    problem.grid = {0.0, 0.025, 400};
    problem.root_at_rest = false;
    problem.sensors.resize(2);
    x.bodies = {{.sensor = 0}, revolute_body(0, 1, exp_so3(Vec3(0.3, -0.2, 0.1)), exp_so3(Vec3(0.1, 0.5, -0.4)))};
    x.bodies[1].point_in_parent = Vec3(0.3, 0.1, 0.0);
    x.bodies[1].point_in_child = Vec3(-0.2, 0.0, 0.1);
    x.errors.resize(2);
    x.spline_coefficients.resize(7, problem.grid.coefficients());
    for (Index k = 0; k < 7; ++k)
      x.spline_coefficients.row(k) = spline_dimension(problem.grid, 0.3 + 0.1 * static_cast<double>(k)).row(0);
    x.spline_coefficients.row(2) += 4.0 * spline_dimension(problem.grid, 5.0).row(0);
    const InsLayout layout = layout_of(problem, x.bodies);
    recording.loggers = {{.name = "log", .time = {}}};
    recording.sensors = {{.name = "a", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}},
                         {.name = "b", .acceleration = {}, .angular_velocity = {}, .field = {}, .faults = {}}};
    for (double t = 0.0; t < problem.grid.end(); t += 0.01) {
      recording.loggers[0].time.push_back(t);
      const auto [interval, u] = problem.grid.locate(t);
      const auto states = body_states(problem, layout, x, interval, spline_basis(u, problem.grid.period));
      for (std::size_t s = 0; s < 2; ++s) {
        for (std::size_t k = 0; k < 3; ++k) {
          recording.sensors[s].angular_velocity.axis[k].push_back(
              static_cast<float>(states[s].angular_velocity[static_cast<Index>(k)]));
          recording.sensors[s].acceleration.axis[k].push_back(
              static_cast<float>(states[s].force[static_cast<Index>(k)]));
        }
        recording.sensors[s].faults.push_back(0);
      }
    }
  }

  /// Largest difference of a recording's forces from those of the chain's low-frequency motion [m/s²].
  double off(const InsRecording& readings, double cutoff) const {
    InsUnknowns slow = x;
    slow.spline_coefficients = low_frequency_motion(x.spline_coefficients, problem.grid, cutoff);
    const InsLayout layout = layout_of(problem, x.bodies);
    double worst = 0.0;
    for (std::size_t row = 100; row + 100 < recording.loggers[0].time.size(); ++row) {
      const auto [interval, u] = problem.grid.locate(recording.loggers[0].time[row]);
      const auto states = body_states(problem, layout, slow, interval, spline_basis(u, problem.grid.period));
      for (std::size_t s = 0; s < 2; ++s)
        worst = std::max(worst, (readings.sensors[s].acceleration.at(row) - states[s].force).norm());
    }
    return worst;
  }
};

TEST(LowFrequency, SamplesThatAChainExplainsAreExplainedWhenFiltered) {
  const Machine machine;
  const InsRecording slow = low_frequency_measurements(machine.recording, machine.problem, machine.x, 1.0, 1);
  EXPECT_LT(machine.off(slow, 1.0), 1e-4);
}

TEST(LowFrequency, OnlyTheResidualOfTheChainIsFiltered) {
  Machine machine;
  for (std::size_t row = 0; row < machine.recording.loggers[0].time.size(); ++row)
    machine.recording.sensors[1].acceleration.axis[0][row] +=
        static_cast<float>(wave(1.0, machine.recording.loggers[0].time[row]));
  const InsRecording slow = low_frequency_measurements(machine.recording, machine.problem, machine.x, 1.0, 1);
  EXPECT_NEAR(machine.off(slow, 1.0), std::numbers::sqrt2 / 2.0, 0.01);
}

TEST(LowFrequency, UnusableRowsStayUnusedAndDoNotAffectTheirNeighbours) {
  Machine machine;
  for (std::size_t row = 400; row < 420; ++row) {
    machine.recording.sensors[1].faults[row] = acceleration_missing;
    machine.recording.sensors[1].acceleration.axis[0][row] = 1e6f;
  }
  const InsRecording slow = low_frequency_measurements(machine.recording, machine.problem, machine.x, 1.0, 1);
  EXPECT_EQ(slow.sensors[1].faults[410], acceleration_missing);
  const Machine sound;
  const InsRecording ought = low_frequency_measurements(sound.recording, sound.problem, sound.x, 1.0, 1);
  for (const std::size_t row : {399u, 420u})
    EXPECT_NEAR(slow.sensors[1].acceleration.axis[0][row], ought.sensors[1].acceleration.axis[0][row], 1e-3);
}

TEST(LowFrequency, IsTheSameForAnyNumberOfThreads) {
  const Machine machine;
  const InsRecording one = low_frequency_measurements(machine.recording, machine.problem, machine.x, 1.0, 1);
  for (const int threads : {2, 7}) {
    const InsRecording many = low_frequency_measurements(machine.recording, machine.problem, machine.x, 1.0, threads);
    for (std::size_t s = 0; s < 2; ++s) EXPECT_EQ(one.sensors[s].acceleration.axis, many.sensors[s].acceleration.axis);
  }
}

}  // namespace
}  // namespace kinfer
