// SPDX-License-Identifier: Apache-2.0
#include "studies/support/optical_truth.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/geometry/mean_revolute.hpp"

namespace kinfer::study {
using namespace identify;
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

double number(const std::vector<std::string>& cells, std::size_t column) {
  if (column >= cells.size() || cells[column].empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::stod(cells[column]);
}

Mat3 rotation_at(const std::vector<std::string>& cells, std::size_t first) {
  return Quat(number(cells, first), number(cells, first + 1), number(cells, first + 2), number(cells, first + 3))
      .normalized()
      .toRotationMatrix();
}

/// The gyro's integral up to each row [rad], whose differences are mean angular velocities times durations.
struct GyroIntegral {
  std::span<const double> time;
  std::vector<Vec3> sum;

  GyroIntegral(const InsSensor& sensor, std::span<const double> t) : time(t) {
    const std::size_t at_rest = std::min<std::size_t>(40, t.size());
    Vec3 bias = Vec3::Zero(), total = Vec3::Zero();
    for (std::size_t i = 0; i < at_rest; ++i) bias += sensor.angular_velocity.at(i) / static_cast<double>(at_rest);
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (i > 0)
        total += (t[i] - t[i - 1]) * (0.5 * (sensor.angular_velocity.at(i) + sensor.angular_velocity.at(i - 1)) - bias);
      sum.push_back(total);
    }
  }

  Vec3 at(double t) const {
    const auto after = std::ranges::lower_bound(time, t);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - time.begin(), 1, static_cast<std::ptrdiff_t>(time.size()) - 1));
    const double share = std::clamp((t - time[i - 1]) / (time[i] - time[i - 1]), 0.0, 1.0);
    return sum[i - 1] + share * (sum[i] - sum[i - 1]);
  }
};

constexpr std::size_t frames = 3;  // between the two of a rotation: a tenth of a second

struct Rotations {
  std::vector<Vec3> optical, gyro;  // [rad] rotation vectors over the same times
};

Rotations rotations_of(const OpticalLog& optical, const std::vector<Mat3>& pose, const GyroIntegral& gyro,
                       double late) {
  Rotations rotations;
  for (std::size_t i = 0; i + frames < optical.time.size(); ++i) {
    const Mat3 rotation = pose[i].transpose() * pose[i + frames];
    const double from = optical.time[i] + late, to = optical.time[i + frames] + late;
    if (!rotation.allFinite() || from < gyro.time.front() || to > gyro.time.back()) continue;
    rotations.optical.push_back(log_so3(rotation));
    rotations.gyro.push_back(gyro.at(to) - gyro.at(from));
  }
  return rotations;
}

/// The rotation about the origin that best maps the first vectors to the second.
Mat3 rotation_between(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  std::vector<Vec3> a = to, b = from;
  for (const Vec3& v : to) a.push_back(-v);  // so that both centroids are the origin
  for (const Vec3& v : from) b.push_back(-v);
  return align_points(a, b).rotation;
}

/// Residual of the best rotation [rad/s], without the worst hundredth (frames beside gaps).
double difference(const Rotations& rotations, const Mat3& rotation) {
  std::vector<double> squares;
  for (std::size_t i = 0; i < rotations.gyro.size(); ++i)
    squares.push_back((rotations.gyro[i] - rotation * rotations.optical[i]).squaredNorm());
  std::ranges::sort(squares);
  squares.resize(squares.size() - squares.size() / 100);
  double sum = 0.0;
  for (const double s : squares) sum += s / static_cast<double>(squares.size());
  return std::sqrt(sum) * 30.0 / static_cast<double>(frames);
}

}  // namespace

Result<OpticalLog> read_optical(const std::string& path, const std::vector<std::string>& segments) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return error("{} cannot be read", path);
  const auto header = cells_of(line);
  OpticalLog log;
  while (std::getline(file, line)) {
    const auto cells = cells_of(line);
    log.time.push_back(number(cells, 0));
    for (const std::string& name : segments) {
      const auto first = std::ranges::find(header, name + "_qw");
      if (first == header.end()) return error("{} has no column {}_qw", path, name);
      log.segment[name].push_back(rotation_at(cells, static_cast<std::size_t>(first - header.begin())));
    }
  }
  return log;
}

OpticalAlignment aligned(const OpticalLog& optical, const InsRecording& recording) {
  OpticalAlignment best;
  double least = std::numeric_limits<double>::infinity();
  for (int step = -30; step <= 30; ++step) {
    OpticalAlignment alignment{.late = 1e-3 * step, .rotation = {}, .rms = {}};
    double sum = 0.0;
    for (const InsSensor& sensor : recording.sensors) {
      const GyroIntegral gyro(sensor, recording.time(sensor));
      const Rotations rotations = rotations_of(optical, optical.segment.at(sensor.name), gyro, alignment.late);
      const Mat3 rotation = rotation_between(rotations.optical, rotations.gyro);
      alignment.rotation[sensor.name] = rotation;
      alignment.rms[sensor.name] = difference(rotations, rotation);
      sum += alignment.rms[sensor.name];
    }
    if (sum < least) least = sum, best = alignment;
  }
  return best;
}

OpticalJoint optical_joint(const OpticalLog& optical, const OpticalAlignment& alignment, const std::string& parent,
                           const std::string& child) {
  std::vector<Mat3> rotations;
  for (std::size_t i = 0; i < optical.time.size(); ++i) {
    const Mat3 r = optical.segment.at(parent)[i].transpose() * optical.segment.at(child)[i];
    if (r.allFinite())
      rotations.push_back(alignment.rotation.at(parent) * r * alignment.rotation.at(child).transpose());
  }
  const MeanRevolute joint =
      fit_mean_revolute(spherical_body(0, 0, Mat3::Identity()), rotations, MatrixXd::Zero(6, 6), 0.0);
  return {joint.body.parent_R_axis.col(2), joint.body.child_R_axis.col(2), joint.axis_deviation};
}

}  // namespace kinfer::study
