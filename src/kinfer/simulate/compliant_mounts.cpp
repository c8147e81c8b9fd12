// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/compliant_mounts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/constants.hpp"
#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr int substeps = 20;  // per row: a twentieth of 5 ms resolves mounts of 100 Hz

/// Input of the mount: specific force, angular velocity and acceleration of the segment.
struct MountInput {
  Vec3 force, angular_velocity, angular_acceleration;
};

MountInput interpolate(const MountInput& a, const MountInput& b, double share) {
  return {a.force + share * (b.force - a.force), a.angular_velocity + share * (b.angular_velocity - a.angular_velocity),
          a.angular_acceleration + share * (b.angular_acceleration - a.angular_acceleration)};
}

/// State of the mount: rotation and displacement of the sensor, and their derivatives.
struct MountState {
  Vec3 rotation = Vec3::Zero(), rotation_velocity = Vec3::Zero(), displacement = Vec3::Zero(), velocity = Vec3::Zero();
};

struct MountDynamics {
  const CompliantMount& mount;
  double omega = 2.0 * std::numbers::pi * mount.frequency;

  MountState at_rest(const MountInput& drive) const {
    return {.rotation = mount.tilt * drive.force,
            .displacement = -(drive.force.array() / (omega * omega * mount.relative_stiffness.array())).matrix()};
  }
  Vec3 rotation_acceleration(const MountState& s, const MountInput& d) const {
    return omega * omega * (mount.tilt * d.force - s.rotation) - 2.0 * mount.damping * omega * s.rotation_velocity -
           d.angular_acceleration;
  }
  Vec3 displacement_acceleration(const MountState& s, const MountInput& d) const {
    return -omega * omega * mount.relative_stiffness.cwiseProduct(s.displacement) -
           2.0 * mount.damping * omega * s.velocity - d.force;
  }
  /// Velocities first, then positions (semi-implicit Euler): stable at this step.
  void advance(MountState& s, const MountInput& d, double step) const {
    s.rotation_velocity += step * rotation_acceleration(s, d);
    s.velocity += step * displacement_acceleration(s, d);
    s.rotation += step * s.rotation_velocity;
    s.displacement += step * s.velocity;
  }
};

std::vector<MountInput> mount_inputs(const SensorMotion& motion, std::span<const double> time) {
  std::vector<MountInput> inputs;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, time.size() - 1);
    inputs.push_back(
        {motion.force[i], motion.angular_velocity[i],
         (motion.angular_velocity[after] - motion.angular_velocity[before]) / (time[after] - time[before])});
  }
  return inputs;
}

/// Replaces one row by the signals of the compliantly mounted sensor.
void apply_mount(SensorMotion& m, std::size_t row, const MountDynamics& dynamics, const MountState& s,
                 const MountInput& d) {
  const Mat3 sensor_R_segment = exp_so3(-s.rotation);
  m.force[row] =
      sensor_R_segment * (d.force + dynamics.displacement_acceleration(s, d) +
                          2.0 * d.angular_velocity.cross(s.velocity) + d.angular_acceleration.cross(s.displacement) +
                          d.angular_velocity.cross(d.angular_velocity.cross(s.displacement)));
  m.angular_velocity[row] = sensor_R_segment * d.angular_velocity + right_jacobian(s.rotation) * s.rotation_velocity;
  m.field[row] = sensor_R_segment * m.field[row];
  m.position[row] += m.world_R_sensor[row] * s.displacement;
  m.world_R_sensor[row] = m.world_R_sensor[row] * quat_exp(s.rotation);
}

void simulate_mount(SensorMotion& motion, std::span<const double> time, const CompliantMount& mount) {
  const MountDynamics dynamics{mount};
  const std::vector<MountInput> inputs = mount_inputs(motion, time);
  MountState s = dynamics.at_rest(inputs.front());
  for (std::size_t row = 0; row < time.size(); ++row) {
    apply_mount(motion, row, dynamics, s, inputs[row]);
    if (row + 1 == time.size()) break;
    const double step = (time[row + 1] - time[row]) / substeps;
    for (int i = 1; i <= substeps; ++i)
      dynamics.advance(s, interpolate(inputs[row], inputs[row + 1], static_cast<double>(i) / substeps), step);
  }
}

}  // namespace

CompliantMount draw_compliant_mount(double tilt, double frequency, Rng rng) {
  const auto three = [&](const auto& draw) {
    Vec3 v;
    for (double& each : v) each = draw();
    return v;
  };
  const auto any = [&] { return rng.normal(); };
  const auto stiffness = [&] { return rng.uniform(0.5, 1.5); };
  const Mat3 foam = exp_so3(three(any)), above = skew(three(any).normalized());
  const Mat3 compliance = foam * three(stiffness).cwiseInverse().asDiagonal() * foam.transpose();
  // Weight −f acting at height h above the foam rotates the sensor by −C (h × f), C the compliance.
  return {.frequency = frequency,
          .tilt = -(tilt / standard_gravity) * compliance * above,
          .relative_stiffness = three(stiffness)};
}

MachineMotion with_compliant_mounts(MachineMotion motion, const std::vector<CompliantMount>& mounts) {
  KINFER_EXPECT(mounts.size() == motion.sensors.size());
  for (std::size_t s = 0; s < mounts.size(); ++s) simulate_mount(motion.sensors[s], motion.time, mounts[s]);
  return motion;
}

MachineMotion with_foam_mounts(MachineMotion motion, double tilt, const Rng& rng) {
  constexpr double natural_frequency = 8.0;  // [Hz]
  std::vector<CompliantMount> mounts;
  for (std::size_t s = 0; s < motion.sensors.size(); ++s)
    mounts.push_back(draw_compliant_mount(tilt, natural_frequency, rng.stream(s)));
  return with_compliant_mounts(std::move(motion), mounts);
}

}  // namespace kinfer
