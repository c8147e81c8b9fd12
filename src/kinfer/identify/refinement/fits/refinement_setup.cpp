// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/fits/refinement_setup.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/constants.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/refinement/fits/thresholds.hpp"

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;

SplineGrid make_grid(const RecordedMotion& motion, double period) {
  constexpr Index min_intervals = spline_order - 1;  // the ends of a time segment do not overlap
  const double length = motion.time.back() - motion.time.front();
  return {motion.time.front(), period, std::max(min_intervals, static_cast<Index>(std::ceil(length / period)))};
}

InsMeasurements sensor_blocks(const InsRecording& recording, const InsSensor& sensor, const SplineGrid& grid) {
  const auto time = recording.time(sensor);
  InsMeasurements r;
  r.angular_velocity = ins_blocks(sensor, time, InsInstrument::gyroscope, grid);
  r.force = ins_blocks(sensor, time, InsInstrument::accelerometer, grid);
  r.clipped_rate = clipped_blocks(sensor, time, InsInstrument::gyroscope, grid);
  r.clipped_force = clipped_blocks(sensor, time, InsInstrument::accelerometer, grid);
  return r;
}

/// By the scatter of the measurements, or where there is too little by the grade's density. What seems less noisy than
/// the quietest instruments is simulated, or stands still below its resolution.
void set_noise(RefinementSetup& setup, const InsRecording& recording, const SensorModel& grade, double least_noise) {
  for (std::size_t s = 0; s < recording.sensors.size(); ++s) {
    InsMeasurements& measured = setup.problem.sensors[s];
    const double bandwidth = std::sqrt(0.5 / median_period(recording.time(recording.sensors[s])));
    const auto noise_of = [&](const std::vector<InsBlock>& blocks, double density, double least_density) {
      const double scatter = measurement_noise(blocks), least = least_noise * least_density * bandwidth,
                   noise = scatter > 0.0 ? scatter : density * bandwidth;
      setup.is_noise_raised |= noise < least;
      return std::max(noise, least);
    };
    measured.noise = {noise_of(measured.angular_velocity, grade.gyroscope.noise_density, least_rate_density),
                      noise_of(measured.force, grade.accelerometer.noise_density, least_force_density)};
    measured.noise_floor = measured.noise;
  }
}

InsErrorPrior prior_of(const SensorModel& grade) {
  // Lower limits: smaller errors cannot be observed, even if a preset states 0.
  return {.gyroscope_bias = std::hypot(grade.gyroscope.bias_sd, 1e-4),
          .accelerometer_bias = std::hypot(grade.accelerometer.bias_sd, 1e-3),
          .gyroscope_scale = grade.gyroscope.scale_sd,
          .accelerometer_scale = grade.accelerometer.scale_sd};
}

/// By a clock that runs c times too fast lever arms seem to be c² times as long. On a base at rest the fit itself
/// compares the accelerometers with gravity, and their common factor is free; elsewhere it is as certain as the rests
/// before the fit say.
void set_common_scales(InsProblem& problem, const InsCommonScales& common) {
  constexpr double free_factor = 10.0, least_scale = 1e-4;
  problem.common = common;
  if (common.is_none()) return;
  problem.prior.gyroscope_scale = std::max(problem.prior.gyroscope_scale, least_scale);
  problem.prior.accelerometer_scale = std::max(problem.prior.accelerometer_scale, least_scale);
  problem.point_sd *= std::max(1.0, common.gyroscope.factor * common.gyroscope.factor);
  if (common.accelerometer.is_none()) return;
  problem.gravity = usual_gravity;
  problem.gravity_sd = usual_gravity_sd;
  const bool was_divided = std::abs(common.accelerometer.factor - 1.0) > 0.0;
  if (problem.root_at_rest && was_divided) problem.common.accelerometer.sd *= free_factor;
}

Vec3 mean_measurement(const std::vector<InsBlock>& blocks) {
  Vec3 sum = Vec3::Zero();
  double weight = 0.0;
  for (const InsBlock& block : blocks)
    if (block.rows > 0) {
      const double first{block.factor(0, 0)};
      sum += first * block.target.row(0).transpose().cast<double>();
      weight += first * double{block.factor.row(0).sum()};
    }
  return weight > 0.0 ? Vec3(sum / weight) : Vec3(Vec3::Zero());
}

MatrixXd as_columns(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  MatrixXd m(static_cast<Index>(a.size()), 6);
  for (std::size_t i = 0; i < a.size(); ++i) m.row(static_cast<Index>(i)) << a[i].transpose(), b[i].transpose();
  return m;
}

/// Spline coefficients of the root's angular velocity and specific force as measured by its own INS.
MatrixXd root_spline_coefficients(const RecordedMotion& motion, const SplineGrid& grid, std::size_t root) {
  const SegmentMotion& m = motion.segments[root];
  std::vector<Vec3> force;
  for (std::size_t i = 0; i < motion.rows(); ++i)
    force.push_back(m.rotation[i].transpose() * (m.acceleration[i] + Vec3(0.0, 0.0, motion.gravity)));
  return fit_spline(grid, motion.time, as_columns(m.gyro, force));
}

/// Attaches every joint's bodies to those of its parent, with their joint positions as splines.
void attach_joints(RefinementSetup& setup, const RecordedMotion& motion, const SegmentTree& tree,
                   const std::vector<InitialJoint>& starts, std::vector<MatrixXd>& rows) {
  InsUnknowns& x = setup.start;
  std::vector<int> body_of_segment(motion.segments.size(), 0);
  x.bodies.push_back({.sensor = static_cast<int>(tree.root)});
  for (const InitialJoint& start : starts) {
    int parent = body_of_segment[start.parent];
    setup.first_body.push_back(x.bodies.size());
    for (InsBody body : start.bodies) {
      body.parent = parent;
      parent = static_cast<int>(x.bodies.size());
      x.bodies.push_back(body);
    }
    body_of_segment[start.child] = parent;
    setup.last_body.push_back(x.bodies.size() - 1);
    for (const std::vector<double>& values : start.joint_positions) {
      const Eigen::Map<const VectorXd> positions(values.data(), static_cast<Index>(values.size()));
      rows.push_back(fit_spline(setup.problem.grid, motion.time, positions));
      setup.problem.anchor.push_back(rows.back()(0, 0));
    }
  }
}

}  // namespace

RefinementSetup set_up_refinement(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                                  const std::vector<InitialJoint>& starts, const SensorModel& grade,
                                  double knot_spacing, double least_noise, const InsCommonScales& common) {
  RefinementSetup setup;
  InsProblem& problem = setup.problem;
  problem.grid = make_grid(motion, knot_spacing);
  problem.root_at_rest = motion.segments[tree.root].still;
  problem.prior = prior_of(grade);
  set_common_scales(problem, common);
  problem.bias_process = {.rate_sd = grade.gyroscope.instability,
                          .force_sd = grade.accelerometer.instability,
                          .time = grade.accelerometer.instability_time};
  for (const InsSensor& sensor : recording.sensors)
    problem.sensors.push_back(sensor_blocks(recording, sensor, problem.grid));
  set_noise(setup, recording, grade, least_noise);
  InsUnknowns& x = setup.start;
  x.errors.resize(recording.sensors.size());
  std::vector<MatrixXd> rows;
  if (problem.root_at_rest) {
    x.root_force = mean_measurement(problem.sensors[tree.root].force);
  } else {
    rows.push_back(root_spline_coefficients(motion, problem.grid, tree.root));
  }
  attach_joints(setup, motion, tree, starts, rows);
  Index spline_dimensions = 0;
  for (const MatrixXd& row : rows) spline_dimensions += row.rows();
  x.spline_coefficients.resize(spline_dimensions, problem.grid.coefficients());
  Index at = 0;
  for (const MatrixXd& row : rows) x.spline_coefficients.middleRows(at, row.rows()) = row, at += row.rows();
  return setup;
}

}  // namespace kinfer::identify
