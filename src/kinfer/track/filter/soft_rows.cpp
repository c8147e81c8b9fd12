// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/soft_rows.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/linalg/small_cholesky.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {

SoftRows::SoftRows(const FilterModel& model) : prismatic_(model.prismatic.size()), revolute_(model.revolute.size()) {
  const Index most = model.layout.positions + 6;
  accelerations_ = MatrixXd::Zero(most, most);
  solution_ = VectorXd::Zero(most);
}

void SoftRows::add(const FilterModel& model, const ChainState& state, const MatrixXd& p, double length,
                   UpdateSystem& system) {
  const auto worth = [&](double sd, double time) { return sd * sd * std::max(1.0, 2.0 * time / length); };
  const auto rests_at = [&](SteadyVelocity& steady, Index velocity, const RestOdds& odds) {
    return rests(steady, state.joints[velocity - base_states], p(velocity, velocity), odds, length);
  };
  if (state.base == BaseMode::moving) {
    base_speed_.add(state.velocity, p.diagonal().segment<3>(BaseIndex::velocity), length);
    for (Index k = 0; k < 3; ++k)
      system.derivative(system.append(-state.velocity[k], worth(base_speed_.sd(), base_velocity_time)),
                        BaseIndex::velocity + k) = 1.0;
  }
  for (std::size_t k = 0; k < model.prismatic.size(); ++k) {
    const PrismaticRange& range = model.prismatic[k];
    const double* x = state.joints.data() + position_states * range.position;
    const Index at = model.layout.joint_state(range.position);
    const RestOdds odds{range.speed, prismatic_creep, prismatic_steadiness};
    const double speed = rests_at(prismatic_[k], at + 1, odds) ? prismatic_creep : range.speed;
    system.derivative(system.append(range.middle - x[0], worth(range.half, prismatic_position_time)), at) = 1.0;
    system.derivative(system.append(-x[1], worth(speed, prismatic_velocity_time)), at + 1) = 1.0;
  }
  for (std::size_t k = 0; k < model.revolute.size(); ++k) {
    const RevoluteBetweenSensors& joint = model.revolute[k];
    const Index at = model.layout.joint_state(joint.position) + 1;
    const bool rests_now = rests_at(revolute_[k], at, {steady_rate, revolute_creep, revolute_steadiness}),
               is_bridged =
                   !system.is_measured()[2 * joint.parent_sensor] || !system.is_measured()[2 * joint.child_sensor];
    if (!is_bridged) continue;
    const bool is_shown = shows_acceleration(model, state.base, system, joint.position);
    if (is_shown && !rests_now) continue;
    const double variance =
        is_shown ? worth(revolute_creep, revolute_rest_time) : worth(joint.speed, unseen_velocity_time);
    system.derivative(system.append(-state.joints[at - base_states], variance), at) = 1.0;
  }
  for (const LooseRevoluteJoint& loose : model.loose) {
    const Mat3& rotation = state.spherical[loose.body];
    const Mat3 by_turn = -rotation * skew(Vec3::UnitZ());
    for (Index k = 0; k < 2; ++k) {
      const Index row = system.append(-rotation(k, 2), worth(loose.stray, loose.time));
      for (Index i = 0; i < 3; ++i)
        system.derivative(row, model.layout.joint_state(model.layout.position[loose.body] + i)) = by_turn(k, i);
    }
  }
}

/// A joint rests where its velocity has been the same for a while, by even odds none. A machine's telescope is locked
/// most of the time, and its acceleration, integrated twice, would drift by decimetres; so does the difference of two
/// parallel joints without the sensor between them.
bool SoftRows::rests(SteadyVelocity& steady, double velocity, double variance, const RestOdds& odds, double length) {
  const auto log_density = [&](double speed) {
    const double all = variance + square(speed);
    return -0.5 * (square(velocity) / all + std::log(all));
  };
  if (std::abs(velocity - steady.velocity) > odds.steadiness) steady = {velocity, 0.0};
  steady.duration += length;
  return steady.duration > joint_rest && log_density(odds.creep) > log_density(odds.speed);
}

/// Whether the sensors that are measured tell a joint's acceleration from those of all others and of the base, by this
/// block alone. Where they do not, a joint that seems to rest may move unseen.
bool SoftRows::shows_acceleration(const FilterModel& model, BaseMode base, const UpdateSystem& system, Index position) {
  const FilterLayout& layout = model.layout;
  const Index joints = layout.positions, all = joints + (base == BaseMode::moving ? 6 : 0);
  const auto process_sd = [&](Index k) {
    return k < joints       ? model.positions[static_cast<std::size_t>(k)].sd
           : k < joints + 3 ? model.base_rotation.sd
                            : model.base_translation.sd;
  };
  const auto state_of = [&](Index k) {
    return k < joints       ? layout.joint_state(k) + 2
           : k < joints + 3 ? BaseIndex::angular_acceleration + k - joints
                            : BaseIndex::acceleration + k - joints - 3;
  };
  auto information = accelerations_.topLeftCorner(all, all);
  information.setZero();
  for (Index k = 0; k < all; ++k) {
    information(k, k) = 1.0 / square(process_sd(k));
    for (Index j = 0; j <= k; ++j)
      for (Index row = 0; row < layout.rows(); ++row)
        information(k, j) +=
            system.derivative(row, state_of(k)) * system.derivative(row, state_of(j)) / system.variance(row);
  }
  if (!factorise_small(information)) return false;
  // The variance is |L⁻¹ e|².
  double variance = 0.0;
  for (Index i = position; i < all; ++i) {
    double x = i == position ? 1.0 : 0.0;
    for (Index j = position; j < i; ++j) x -= information(i, j) * solution_[j];
    solution_[i] = x / information(i, i);
    variance += square(solution_[i]);
  }
  return variance < shown_acceleration * square(process_sd(position));
}

}  // namespace kinfer::track
