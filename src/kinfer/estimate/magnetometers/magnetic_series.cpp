// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/magnetic_series.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/geometry/statistics.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double shortest_bin = 0.1;  // [s] 1 rad/s then shortens a mean by 4e-4
constexpr double most_bins = 6000.0;

Mat3 joint_rotation(JointMotion motion, ConstVectorRef positions, Index first) {
  if (motion == JointMotion::revolute) return rot_z(positions[first]);
  if (motion == JointMotion::spherical) return exp_so3(positions.segment<3>(first));
  return Mat3::Identity();
}

/// root_R_body of all bodies at one time.
std::vector<Mat3> body_rotations(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                 double time) {
  const VectorXd positions = spline_value(problem.grid, x.spline_coefficients, time);
  std::vector<Mat3> rotations{Mat3::Identity()};
  for (std::size_t b = 1; b < x.bodies.size(); ++b) {
    const InsBody& body = x.bodies[b];
    rotations.push_back(rotations[static_cast<std::size_t>(body.parent)] * body.parent_R_axis *
                        joint_rotation(body.motion, positions, layout.spline_dimension[b]) *
                        body.child_R_axis.transpose());
  }
  return rotations;
}

/// Means of the field in each bin.
void add_field(MagneticSeries& series, const InsSensor& sensor, std::span<const double> time, const InsClock& clock,
               const SplineGrid& grid, double bin) {
  std::vector<double> count(series.field.size(), 0.0);
  const double middle = 0.5 * (grid.begin + grid.end());
  for (std::size_t row = 0; row < time.size(); ++row) {
    const InsSample s = sample(sensor, time, row);
    const double at = time[row] + clock.offset + clock.drift * (time[row] - middle);
    const auto k = static_cast<std::ptrdiff_t>(std::floor((at - grid.begin) / bin));
    if (!s.has_field || k < 0 || k >= static_cast<std::ptrdiff_t>(count.size())) continue;
    series.field[static_cast<std::size_t>(k)] += s.field;
    count[static_cast<std::size_t>(k)] += 1.0;
  }
  for (std::size_t k = 0; k < count.size(); ++k) {
    series.is_valid[k] = count[k] > 0.0;
    if (series.is_valid[k]) series.field[k] /= count[k];
  }
}

std::vector<std::size_t> path_to(const InsBodies& bodies, std::size_t body) {
  std::vector<std::size_t> path;
  for (; body > 0; body = static_cast<std::size_t>(bodies[body].parent)) path.push_back(body);
  std::ranges::reverse(path);
  return path;
}

double median_strength(const std::vector<MagneticSeries>& sensors) {
  std::vector<double> norms;
  for (const MagneticSeries& series : sensors)
    for (std::size_t k = 0; k < series.field.size(); ++k)
      if (series.is_valid[k]) norms.push_back(series.field[k].norm());
  return norms.empty() ? 0.0 : median(norms);
}

}  // namespace

MagneticRecording magnetic_recording(const InsRecording& recording, const InsProblem& problem, const InsLayout& layout,
                                     const InsUnknowns& x) {
  const SplineGrid& grid = problem.grid;
  const double duration = grid.end() - grid.begin, bin = std::max(shortest_bin, duration / most_bins);
  MagneticRecording result{.bins = static_cast<std::size_t>(std::max(1.0, std::floor(duration / bin)))};
  result.root_R_body.resize(x.bodies.size());
  for (std::size_t k = 0; k < result.bins; ++k) {
    const auto rotations = body_rotations(problem, layout, x, grid.begin + bin * (static_cast<double>(k) + 0.5));
    for (std::size_t b = 0; b < rotations.size(); ++b) result.root_R_body[b].push_back(rotations[b]);
  }
  for (std::size_t b = 0; b < x.bodies.size(); ++b) {
    if (x.bodies[b].sensor < 0) continue;
    const auto index = static_cast<std::size_t>(x.bodies[b].sensor);
    const InsSensor& sensor = recording.sensors[index];
    if (!sensor.has_magnetometer()) continue;
    MagneticSeries series{.sensor = index,
                          .path = path_to(x.bodies, b),
                          .field = std::vector<Vec3>(result.bins, Vec3::Zero()),
                          .is_valid = std::vector<bool>(result.bins, false),
                          .root_R_sensor = result.root_R_body[b]};
    add_field(series, sensor, recording.time(sensor), x.errors[index].clock, grid, bin);
    if (std::ranges::count(series.is_valid, true) > 0) result.sensors.push_back(std::move(series));
  }
  result.strength = median_strength(result.sensors);
  return result;
}

}  // namespace kinfer
