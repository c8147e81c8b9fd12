#include "kinfer/identify/refine.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/ins_fact_rows.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/named_facts.hpp"
#include "kinfer/inertial/sensor_judgement.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double field_trust = 0.1;  // [of the field] sd of a tenth of a second: steel moves, so only a weak gauge

SplineGrid grid_over(const RecordedMotion& motion, double period) {
  const double length = motion.time.back() - motion.time.front();
  return {motion.time.front(), period, std::max<Index>(1, static_cast<Index>(std::ceil(length / period)))};
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
  r.rate_sd = noise_or(reading_noise(r.rate), grade.gyroscope.noise_density, rate);
  r.force_sd = noise_or(reading_noise(r.force), grade.accelerometer.noise_density, rate);
  if (!use_field || !sensor.has_magnetometer()) return r;
  r.field = mean_blocks(sensor, time, InsInstrument::magnetometer, grid);
  std::vector<double> sizes;
  for (const InsBlock& block : r.field)
    if (block.rows > 0) sizes.push_back(block.target.row(0).norm());
  if (sizes.empty())
    r.field.clear();
  else
    r.field_sd = field_trust * median(sizes);
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
      sum += block.target.row(0).transpose() * block.factor(0, 0);
      weight += block.factor(0, 0) * block.factor.row(0).sum();
    }
  return weight > 0.0 ? Vec3(sum / weight) : Vec3(Vec3::Zero());
}

InsBody body_of(const JointStart& start, int parent) {
  const int sensor = static_cast<int>(start.child);
  InsBody body;
  switch (start.type) {
    case FoundJointType::revolute:
      body = turning_body(parent, sensor, start.parent_R_axis, start.child_R_axis);
      break;
    case FoundJointType::prismatic:
      body = sliding_body(parent, sensor, start.parent_R_axis, start.child_R_axis);
      break;
    case FoundJointType::rigid:
      body = fixed_body(parent, sensor, start.parent_R_axis * start.child_R_axis.transpose());
      break;
  }
  body.point_in_parent = start.point_in_parent;
  body.point_in_child = start.point_in_child;
  return body;
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

std::vector<std::string> names_of(const RecordedMotion& motion) {
  std::vector<std::string> names;
  for (const SegmentMotion& segment : motion.segments) names.push_back(segment.name);
  return names;
}

std::vector<FoundPlace> found_places(const MachineFacts& facts, const InsFit& fit, ConstMatrixRef covariance) {
  std::vector<FoundPlace> places;
  for (std::size_t i = 0; i < facts.places.size(); ++i) {
    const Index at = fit.layout.facts + 3 * static_cast<Index>(i);
    places.push_back({facts.places[i].name, facts.places[i].sensor, fit.unknowns.facts.places[i],
                      covariance.diagonal().segment<3>(at).cwiseSqrt()});
  }
  return places;
}

struct Setup {
  InsProblem problem;
  InsUnknowns start;
};

Setup setup_of(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
               const std::vector<JointStart>& starts, const SensorModel& grade, const RefineOptions& options) {
  Setup setup;
  InsProblem& problem = setup.problem;
  problem.grid = grid_over(motion, options.knots);
  problem.root_stands_still = motion.segments[tree.root].still;
  problem.prior = prior_of(grade);
  for (const InsSensor& sensor : recording.sensors)
    problem.sensors.push_back(readings_of(recording, sensor, problem.grid, grade, problem.root_stands_still));
  InsUnknowns& x = setup.start;
  x.errors.resize(recording.sensors.size());
  std::vector<int> body_of_segment(recording.sensors.size(), 0);
  x.bodies.push_back({.sensor = static_cast<int>(tree.root)});
  std::vector<MatrixXd> rows;
  if (problem.root_stands_still) {
    x.root_force = mean_reading(problem.sensors[tree.root].force);
    if (!problem.sensors[tree.root].field.empty()) x.root_field = mean_reading(problem.sensors[tree.root].field);
  } else {
    rows.push_back(root_band(motion, problem.grid, tree.root));
  }
  for (const JointStart& start : starts) {
    body_of_segment[start.child] = static_cast<int>(x.bodies.size());
    x.bodies.push_back(body_of(start, body_of_segment[start.parent]));
    if (start.reading.empty()) continue;
    const Eigen::Map<const VectorXd> reading(start.reading.data(), static_cast<Index>(start.reading.size()));
    rows.push_back(fit_spline(problem.grid, motion.time, reading));
    problem.anchor.push_back(rows.back()(0, 0));
  }
  Index channels = 0;
  for (const MatrixXd& row : rows) channels += row.rows();
  x.band.resize(channels, problem.grid.coefficients());
  Index at = 0;
  for (const MatrixXd& row : rows) x.band.middleRows(at, row.rows()) = row, at += row.rows();
  return setup;
}

}  // namespace

Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<JointStart>& starts, const RefineOptions& options,
                          const Observer& observer) {
  const SensorModel grade = options.grade ? *options.grade : judged_model(recording);
  Setup setup = setup_of(recording, motion, tree, starts, grade, options);
  KINFER_TRY(facts, named_facts(options.facts, names_of(motion), setup.start.bodies, setup.problem.grid,
                                setup.problem.root_stands_still));
  setup.problem.facts = facts;
  setup.start.facts = started_facts(setup.problem, layout_of(setup.problem, setup.start.bodies), setup.start);
  Refinement result;
  result.grade = grade.name;
  result.fit = fit_ins(setup.problem, setup.start, options.fit, observer);
  const auto system = eliminated(setup.problem, result.fit.layout, result.fit.unknowns, {}, options.fit.threads);
  if (!system.positive()) return error("the continuous-time fit has no covariance: the recording says too little");
  const auto covariance = inverse_positive(system.schur());
  if (!covariance) return error("the continuous-time fit has no covariance: the recording says too little");
  result.covariance = *covariance;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Index first = result.fit.layout.body[i + 1], channel = result.fit.layout.channel[i + 1];
    const double zero =
        channel < 0 ? 0.0
                    : spline_value(setup.problem.grid, result.fit.unknowns.band, setup.problem.grid.begin)[channel];
    const InsBody& body = result.fit.unknowns.bodies[i + 1];
    const Index n = body.unknowns();
    RefinedJoint joint = refined_joint(starts[i].type, body, zero, covariance->block(first, first, n, n));
    joint.found.parent = motion.segments[starts[i].parent].name;
    joint.found.child = motion.segments[starts[i].child].name;
    result.joints.push_back(joint);
  }
  result.places = found_places(options.facts, result.fit, *covariance);
  return result;
}

}  // namespace kinfer
