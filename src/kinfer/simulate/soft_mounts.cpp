#include "kinfer/simulate/soft_mounts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

constexpr int substeps = 20;  // of a row: a twentieth of 5 ms resolves mounts of 100 Hz

/// What shakes the mount.
struct Drive {
  Vec3 force, rate, rate_change;
};

Drive between(const Drive& a, const Drive& b, double share) {
  return {a.force + share * (b.force - a.force), a.rate + share * (b.rate - a.rate),
          a.rate_change + share * (b.rate_change - a.rate_change)};
}

/// Where the sensor is on its segment.
struct Sway {
  Vec3 turn = Vec3::Zero(), turning = Vec3::Zero(), shift = Vec3::Zero(), shifting = Vec3::Zero();
};

struct Swaying {
  const SoftMount& mount;
  double omega = 2.0 * std::numbers::pi * mount.frequency;

  Sway at_rest(const Drive& drive) const {
    return {.turn = mount.tilt * drive.force,
            .shift = -(drive.force.array() / (omega * omega * mount.stretch.array())).matrix()};
  }
  Vec3 turn_change(const Sway& s, const Drive& d) const {
    return omega * omega * (mount.tilt * d.force - s.turn) - 2.0 * mount.damping * omega * s.turning - d.rate_change;
  }
  Vec3 shift_change(const Sway& s, const Drive& d) const {
    return -omega * omega * mount.stretch.cwiseProduct(s.shift) - 2.0 * mount.damping * omega * s.shifting - d.force;
  }
  /// Rates first, then places (semi-implicit Euler): stable at this step.
  void advance(Sway& s, const Drive& d, double step) const {
    s.turning += step * turn_change(s, d);
    s.shifting += step * shift_change(s, d);
    s.turn += step * s.turning;
    s.shift += step * s.shifting;
  }
};

std::vector<Drive> drives_of(const SensorMotion& motion, std::span<const double> time) {
  std::vector<Drive> drives;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : i, after = std::min(i + 1, time.size() - 1);
    drives.push_back(
        {motion.force[i], motion.rate[i], (motion.rate[after] - motion.rate[before]) / (time[after] - time[before])});
  }
  return drives;
}

/// One row as the swaying sensor feels it.
void feel(SensorMotion& m, std::size_t row, const Swaying& swaying, const Sway& s, const Drive& d) {
  const Mat3 sensor_R_segment = exp_so3(-s.turn);
  m.force[row] = sensor_R_segment * (d.force + swaying.shift_change(s, d) + 2.0 * d.rate.cross(s.shifting) +
                                     d.rate_change.cross(s.shift) + d.rate.cross(d.rate.cross(s.shift)));
  m.rate[row] = sensor_R_segment * d.rate + right_jacobian(s.turn) * s.turning;
  m.field[row] = sensor_R_segment * m.field[row];
  m.position[row] += m.world_R_sensor[row] * s.shift;
  m.world_R_sensor[row] = m.world_R_sensor[row] * quat_exp(s.turn);
}

void sway(SensorMotion& motion, std::span<const double> time, const SoftMount& mount) {
  const Swaying swaying{mount};
  const std::vector<Drive> drives = drives_of(motion, time);
  Sway s = swaying.at_rest(drives.front());
  for (std::size_t row = 0; row < time.size(); ++row) {
    feel(motion, row, swaying, s, drives[row]);
    if (row + 1 == time.size()) break;
    const double step = (time[row + 1] - time[row]) / substeps;
    for (int i = 1; i <= substeps; ++i)
      swaying.advance(s, between(drives[row], drives[row + 1], static_cast<double>(i) / substeps), step);
  }
}

}  // namespace

SoftMount drawn_soft_mount(double lean, double frequency, Rng rng) {
  constexpr double gravity = 9.81;
  const auto three = [&](const auto& draw) {
    Vec3 v;
    for (double& each : v) each = draw();
    return v;
  };
  const auto any = [&] { return rng.normal(); };
  const auto stiffness = [&] { return rng.uniform(0.5, 1.5); };
  const Mat3 foam = exp_so3(three(any)), above = skew(three(any).normalized());
  const Mat3 gives = foam * three(stiffness).cwiseInverse().asDiagonal() * foam.transpose();
  // Weight −f at the mass' place h above the foam turns it by −gives (h × f).
  return {.frequency = frequency, .tilt = -(lean / gravity) * gives * above, .stretch = three(stiffness)};
}

MachineMotion with_soft_mounts(MachineMotion motion, const std::vector<SoftMount>& mounts) {
  KINFER_EXPECT(mounts.size() == motion.sensors.size());
  for (std::size_t s = 0; s < mounts.size(); ++s) sway(motion.sensors[s], motion.time, mounts[s]);
  return motion;
}

MachineMotion on_foam(MachineMotion motion, double lean, const Rng& rng) {
  constexpr double swaying = 8.0;  // [Hz]
  std::vector<SoftMount> mounts;
  for (std::size_t s = 0; s < motion.sensors.size(); ++s)
    mounts.push_back(drawn_soft_mount(lean, swaying, rng.stream(s)));
  return with_soft_mounts(std::move(motion), mounts);
}

}  // namespace kinfer
