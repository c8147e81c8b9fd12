// SPDX-License-Identifier: Apache-2.0
#include "studies/lengths/arm_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinfer/geometry/fit.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/text/csv.hpp"

namespace kinfer::study::lengths_study {
namespace {

constexpr double quarter = std::numbers::pi / 2.0, half = std::numbers::pi;
constexpr std::size_t links = 6;

/// link_R_joint of joints 1 to 6 at joint position 0: every joint turns about its z axis (iiwa_description).
const std::array<Mat3, links>& joint_frames() {
  static const std::array<Mat3, links> frames{
      Mat3::Identity(),
      from_rpy({quarter, 0.0, half}),
      from_rpy({quarter, 0.0, half}),
      from_rpy({quarter, 0.0, 0.0}),
      from_rpy({-quarter, half, 0.0}),
      from_rpy({quarter, 0.0, 0.0}),
  };
  return frames;
}

struct Encoders {
  std::vector<double> time;
  std::vector<std::array<double, links>> q;  // [rad]
};

Result<Encoders> read_encoders(const std::filesystem::path& path) {
  KINFER_TRY(text, read_text_file(path));
  KINFER_TRY(table, split_csv(text, path.string()));
  Encoders encoders;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    encoders.time.push_back(parse_number(table.cell(row, 0)).value_or(0.0));
    for (std::size_t j = 0; j < links; ++j) {
      if (j == 0) encoders.q.emplace_back();
      encoders.q.back()[j] = parse_number(table.cell(row, j + 1)).value_or(0.0);
    }
  }
  return encoders;
}

/// Angular velocity of every link in its own frame, by differences over `reach` rows to both sides.
std::vector<std::array<Vec3, links>> link_rates(const Encoders& encoders, std::size_t reach) {
  std::vector<std::array<Vec3, links>> rates;
  for (std::size_t row = reach; row + reach < encoders.q.size(); ++row) {
    std::array<Vec3, links> rate;
    Vec3 before = Vec3::Zero();
    for (std::size_t j = 0; j < links; ++j) {
      const double speed = (encoders.q[row + reach][j] - encoders.q[row - reach][j]) /
                           (encoders.time[row + reach] - encoders.time[row - reach]);
      const Mat3 parent_R_link = joint_frames()[j] * rot_z(encoders.q[row][j]);
      before = rate[j] = parent_R_link.transpose() * before + speed * Vec3::UnitZ();
    }
    rates.push_back(rate);
  }
  return rates;
}

Vec3 mean_rate(const InsSensor& sensor, std::size_t row, std::size_t reach) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = row - reach; i <= row + reach; ++i) sum += sensor.angular_velocity.at(i);
  return sum / static_cast<double>(2 * reach + 1);
}

/// The joint whose parent and child are the links `joint` − 1 and `joint`, whichever of both is nearer the root.
std::optional<JointEstimate> joint_of(const Identification& found, const std::vector<std::string>& sensors, int joint) {
  const std::string &near = sensors[static_cast<std::size_t>(joint) - 2],
                    &far = sensors[static_cast<std::size_t>(joint) - 1];
  for (JointEstimate j : found.joints) {
    if (j.parent == near && j.child == far) return j;
    if (j.parent != far || j.child != near) continue;
    std::swap(j.parent, j.child);
    std::swap(j.axis_in_parent, j.axis_in_child);
    std::swap(j.point_in_parent, j.point_in_child);
    std::swap(j.sd.axis_in_parent, j.sd.axis_in_child);
    std::swap(j.sd.point_in_parent, j.sd.point_in_child);
    return j;
  }
  return std::nullopt;
}

double both_sd(const std::array<double, 2>& sd) {
  return std::hypot(sd[0], sd[1]);
}

/// Position along a line of its point nearest to another one.
double foot(const Vec3& axis, const Vec3& point, const Vec3& other_axis, const Vec3& other_point) {
  const double cosine = axis.dot(other_axis);
  const Vec3 between = other_point - point;
  return (between.dot(axis) - cosine * between.dot(other_axis)) / (1.0 - cosine * cosine);
}

}  // namespace

Result<std::vector<Mat3>> link_rotations(const InsRecording& recording, const std::filesystem::path& path,
                                         const std::vector<std::string>& sensors) {
  constexpr std::size_t reach = 10;  // rows: a tenth of a second to both sides
  KINFER_TRY(encoders, read_encoders(path));
  const auto rates = link_rates(encoders, reach);
  std::vector<Mat3> rotations;
  for (std::size_t link = 0; link < links; ++link) {
    const auto sensor = std::ranges::find(recording.sensors, sensors[link], &InsSensor::name);
    if (sensor == recording.sensors.end()) return error("no sensor {}", sensors[link]);
    std::vector<Vec3> by_encoders, by_gyro;
    for (std::size_t i = 0; i < rates.size() && i + 2 * reach < sensor->rows(); ++i) {
      by_encoders.push_back(rates[i][link]);
      by_gyro.push_back(mean_rate(*sensor, i + reach, reach));
    }
    rotations.push_back(align_points(by_gyro, by_encoders).rotation);
  }
  return rotations;
}

std::vector<AxisError> axis_errors(const Identification& found, const std::vector<std::string>& sensors,
                                   const std::vector<Mat3>& sensor_R_link) {
  std::vector<AxisError> errors;
  const auto add = [&](int joint, std::size_t link, const Vec3& axis, const Vec3& in_link,
                       const std::array<double, 2>& sd) {
    const double sine = axis.cross(sensor_R_link[link] * in_link).norm();
    errors.push_back({joint, sensors[link], std::asin(std::min(1.0, sine)), both_sd(sd)});
  };
  for (int joint = 2; joint <= static_cast<int>(links); ++joint) {
    const auto j = joint_of(found, sensors, joint);
    if (!j || j->type != EstimatedJointType::revolute) continue;
    const auto child = static_cast<std::size_t>(joint) - 1;
    if (joint > 2) add(joint, child - 1, j->axis_in_parent, joint_frames()[child].col(2), j->sd.axis_in_parent);
    add(joint, child, j->axis_in_child, Vec3::UnitZ(), j->sd.axis_in_child);
  }
  return errors;
}

std::optional<AxialLength> axial_length(const Identification& found, const std::vector<std::string>& sensors,
                                        int middle) {
  const auto in = joint_of(found, sensors, middle - 1), along = joint_of(found, sensors, middle),
             out = joint_of(found, sensors, middle + 1);
  if (!in || !along || !out) return std::nullopt;
  const double begin = foot(along->axis_in_parent, along->point_in_parent, in->axis_in_child, in->point_in_child),
               end = foot(along->axis_in_child, along->point_in_child, out->axis_in_parent, out->point_in_parent);
  const auto largest = [](const std::array<double, 2>& sd) { return std::max(sd[0], sd[1]); };
  return AxialLength{std::abs(end - begin), std::hypot(largest(in->sd.point_in_child), along->sd.along_axis,
                                                       largest(out->sd.point_in_parent))};
}

}  // namespace kinfer::study::lengths_study
