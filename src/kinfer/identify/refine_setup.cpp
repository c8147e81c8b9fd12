#include "kinfer/identify/refine_setup.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double field_trust = 0.1;  // [of the field] sd of a tenth of a second: steel moves, so only a weak gauge

SplineGrid grid_over(const RecordedMotion& motion, double period) {
  constexpr Index least = spline_order - 1;  // a stretch's ends do not overlap
  const double length = motion.time.back() - motion.time.front();
  return {motion.time.front(), period, std::max(least, static_cast<Index>(std::ceil(length / period)))};
}

double noise_or(double measured, double density, double rate) {
  return measured > 0.0 ? measured : density * std::sqrt(0.5 * rate);
}

InsReadings readings_of(const InsRecording& recording, const InsSensor& sensor, const SplineGrid& grid,
                        const SensorModel& grade, bool use_field) {
  const auto time = recording.time(sensor);
  const double rate = 1.0 / typical_period(time);
  InsReadings r;
  r.rate = ins_blocks(sensor, time, InsInstrument::gyroscope, grid);
  r.force = ins_blocks(sensor, time, InsInstrument::accelerometer, grid);
  r.noise.rate = noise_or(reading_noise(r.rate), grade.gyroscope.noise_density, rate);
  r.noise.force = noise_or(reading_noise(r.force), grade.accelerometer.noise_density, rate);
  if (!use_field || !sensor.has_magnetometer()) return r;
  r.field = mean_blocks(sensor, time, InsInstrument::magnetometer, grid);
  std::vector<double> sizes;
  for (const InsBlock& block : r.field)
    if (block.rows > 0) sizes.push_back(double{block.target.row(0).norm()});
  if (sizes.empty())
    r.field.clear();
  else
    r.noise.field = field_trust * median(sizes);
  return r;
}

InsErrorPrior prior_of(const SensorModel& grade) {
  // What a preset calls perfect is still only as good as can be seen.
  return {.rate_bias = std::hypot(grade.gyroscope.bias_sd, 1e-4),
          .force_bias = std::hypot(grade.accelerometer.bias_sd, 1e-3),
          .field_bias = std::hypot(grade.magnetometer.bias_sd, 0.01),
          .rate_matrix = grade.gyroscope.scale_sd,
          .force_matrix = grade.accelerometer.scale_sd};
}

Vec3 mean_reading(const std::vector<InsBlock>& blocks) {
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

/// Spline coefficients of the root's rate and specific force as its own INS read them.
MatrixXd root_band(const RecordedMotion& motion, const SplineGrid& grid, std::size_t root) {
  const SegmentMotion& m = motion.segments[root];
  std::vector<Vec3> force;
  for (std::size_t i = 0; i < motion.rows(); ++i)
    force.push_back(m.rotation[i].transpose() * (m.acceleration[i] + Vec3(0.0, 0.0, 9.81)));
  return fit_spline(grid, motion.time, as_columns(m.gyro, force));
}

/// Every joint's bodies behind those of its parent, and their readings as splines.
void hang_joints(RefineSetup& setup, const RecordedMotion& motion, const SegmentTree& tree,
                 const std::vector<JointStart>& starts, std::vector<MatrixXd>& rows) {
  InsUnknowns& x = setup.start;
  std::vector<int> body_of_segment(motion.segments.size(), 0);
  x.bodies.push_back({.sensor = static_cast<int>(tree.root)});
  for (const JointStart& start : starts) {
    int parent = body_of_segment[start.parent];
    setup.first_body.push_back(x.bodies.size());
    for (InsBody body : start.bodies) {
      body.parent = parent;
      parent = static_cast<int>(x.bodies.size());
      x.bodies.push_back(body);
    }
    body_of_segment[start.child] = parent;
    setup.last_body.push_back(x.bodies.size() - 1);
    for (const std::vector<double>& values : start.readings) {
      const Eigen::Map<const VectorXd> reading(values.data(), static_cast<Index>(values.size()));
      rows.push_back(fit_spline(setup.problem.grid, motion.time, reading));
      setup.problem.anchor.push_back(rows.back()(0, 0));
    }
  }
}

}  // namespace

RefineSetup refine_setup(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                         const std::vector<JointStart>& starts, const SensorModel& grade, double knots) {
  RefineSetup setup;
  InsProblem& problem = setup.problem;
  problem.grid = grid_over(motion, knots);
  problem.root_stands_still = motion.segments[tree.root].still;
  problem.prior = prior_of(grade);
  problem.wander = {.rate_sd = grade.gyroscope.instability,
                    .force_sd = grade.accelerometer.instability,
                    .time = grade.accelerometer.instability_time};
  for (const InsSensor& sensor : recording.sensors)
    problem.sensors.push_back(readings_of(recording, sensor, problem.grid, grade, problem.root_stands_still));
  for (InsReadings& readings : problem.sensors) readings.least = readings.noise;
  InsUnknowns& x = setup.start;
  x.errors.resize(recording.sensors.size());
  std::vector<MatrixXd> rows;
  if (problem.root_stands_still) {
    x.root_force = mean_reading(problem.sensors[tree.root].force);
    if (!problem.sensors[tree.root].field.empty()) x.root_field = mean_reading(problem.sensors[tree.root].field);
  } else {
    rows.push_back(root_band(motion, problem.grid, tree.root));
  }
  hang_joints(setup, motion, tree, starts, rows);
  Index channels = 0;
  for (const MatrixXd& row : rows) channels += row.rows();
  x.band.resize(channels, problem.grid.coefficients());
  Index at = 0;
  for (const MatrixXd& row : rows) x.band.middleRows(at, row.rows()) = row, at += row.rows();
  return setup;
}

}  // namespace kinfer
