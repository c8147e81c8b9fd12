// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/limb_turns.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Of the segment's joint, in the base.
Vec3 axis_of(const FilterModel& model, const ChainState& state, const UnknownTurn& turn) {
  return parent_side(model, state, turn.segment).parent_R_axis.col(2);
}

/// [rad] Of the base against the axis.
double whole_tilt(const FilterModel& model, const ChainState& state, const UnknownTurn& turn) {
  const Vec3 up = state.world_R_base.row(2);
  return up.cross(axis_of(model, state, turn)).norm();
}

/// [rad/s]
double tilting(const FilterModel& model, const ChainState& state, const UnknownTurn& turn) {
  return state.rate.cross(axis_of(model, state, turn)).norm();
}

}  // namespace

LimbTurns::LimbTurns(const FilterModel& model) : variance_(VectorXd::Zero(model.layout.rows())) {
  for (const UnknownTurn& turn : model.unknown_turns) limbs_.push_back({.body = turn.body});
}

void LimbTurns::begin() {
  for (Limb& limb : limbs_) limb.tilt = 0.0;
}

bool LimbTurns::is_known(std::size_t body) const {
  return std::ranges::find(limbs_, body, &Limb::body)->is_known;
}

void LimbTurns::know(std::size_t body, bool is_known) {
  std::ranges::find(limbs_, body, &Limb::body)->is_known = is_known;
}

double LimbTurns::tilt(const FilterModel& model, const ChainState& state, const MatrixXd& p, const UnknownTurn& turn) {
  const double least = std::max(least_tilt, tilt_sds * std::sqrt(p.diagonal().head<3>().maxCoeff()));
  return std::sqrt(std::max(0.0, square(whole_tilt(model, state, turn)) - square(least)));
}

bool LimbTurns::are_shown(const FilterModel& model, const ChainState& state, const MatrixXd& p,
                          const UnknownTurn& turn) {
  const double turning = state.joints[position_states * model.layout.position[turn.segment] + 1];
  return tilt(model, state, p, turn) > 0.0 && std::max(std::abs(turning), tilting(model, state, turn)) > turn_shown;
}

/// By the chord of the circle that the tilt's direction is anywhere on.
void LimbTurns::free_first_joint(const FilterModel& model, const UnknownTurn& turn, double square_tilt, MatrixXd& p) {
  const JointMotion motion = model.bodies[turn.body].motion;
  if (motion == JointMotion::prismatic) return;
  for (Index i = 0; i < degrees_of_freedom(motion); ++i) {
    const Index at = model.layout.joint_state(model.layout.position[turn.body] + i);
    p(at, at) += 2.0 * square_tilt;
  }
}

/// A base that moves is no level ground that seems to be tilted: all of its tilt counts.
void LimbTurns::update(const FilterModel& model, const ChainState& state, MatrixXd& p) {
  variance_.setZero();
  for (std::size_t k = 0; k < limbs_.size(); ++k) {
    if (limbs_[k].is_known) continue;
    const UnknownTurn& turn = model.unknown_turns[k];
    const double now = state.base == BaseMode::moving ? whole_tilt(model, state, turn) : tilt(model, state, p, turn),
                 more = square(now) - square(limbs_[k].tilt);
    if (more > 0.0) {
      free_first_joint(model, turn, more, p);
      limbs_[k].tilt = now;
    }
    for (const std::size_t s : turn.sensors) {
      const Index row = sensor_rows * static_cast<Index>(s);
      variance_.segment<3>(row).array() += turn_blocks * square(tilting(model, state, turn));
      variance_.segment<3>(row + 3).array() += turn_blocks * square(model.gravity * now);
    }
  }
}

}  // namespace kinfer::track
