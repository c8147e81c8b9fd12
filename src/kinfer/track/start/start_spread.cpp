// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/start_spread.hpp"

#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/track/readout/readout.hpp"

namespace kinfer::track {
namespace {

void widen(Eigen::Ref<VectorXd> sd, const Eigen::Ref<const Eigen::ArrayXd>& variance) {
  sd = (sd.array().square() + variance).max(0.0).sqrt();
}

}  // namespace

StartSpread::StartSpread(const TrackingModel& model, const FilterModel& filter)
    : model_(model),
      tool_(filter, model.tool),
      turns_(static_cast<std::size_t>(model.positions()), true),
      stated_(unknown_state(model)),
      one_(stated_) {
  for (const TrackingJoint& joint : model.joints)
    if (joint.type == EstimatedJointType::prismatic) turns_[static_cast<std::size_t>(joint.first_position)] = false;
  clear();
}

void StartSpread::clear() {
  q_ = qd_ = Eigen::ArrayXd::Zero(model_.positions());
  base_.setZero();
  tool_position_.setZero();
  tool_rotation_.setZero();
}

void StartSpread::read(const ChainFilter& filter, std::span<const double> unknown, TrackState& to) {
  track::read_out(model_, filter.model(), filter.state(), filter.covariance(), to);
  tool_.spread(filter.model(), filter.state(), filter.covariance(), unknown);
  to.base_T_tool = tool_.tool();
  to.sd_tool_position = tool_.position_sd();
  to.sd_tool_rotation = tool_.rotation_sd();
}

void StartSpread::add(const TrackState& one, const TrackState& stated, double probability) {
  const auto more = [&](const auto& sd, const auto& sd_stated, const auto& apart) {
    return (probability * (sd.array().square() - sd_stated.array().square() + apart.array().square())).eval();
  };
  VectorXd apart = one.q - stated.q;
  for (std::size_t i = 0; i < turns_.size(); ++i)
    if (turns_[i]) apart[static_cast<Index>(i)] = wrap_to_pi(apart[static_cast<Index>(i)]);
  q_ += more(one.sd_q, stated.sd_q, apart);
  qd_ += more(one.sd_qd, stated.sd_qd, one.qd - stated.qd);
  base_ += more(one.sd_base, stated.sd_base, quat_log(one.world_q_base * stated.world_q_base.conjugate()));
  tool_position_ +=
      more(one.sd_tool_position, stated.sd_tool_position, Vec3(one.base_T_tool.position - stated.base_T_tool.position));
  tool_rotation_ += more(one.sd_tool_rotation, stated.sd_tool_rotation,
                         log_so3(one.base_T_tool.rotation * stated.base_T_tool.rotation.transpose()));
}

void StartSpread::update(const StartGrid& grid, std::span<const double> unknown) {
  clear();
  read(grid.stated(), unknown, stated_);
  for (const StartGrid::Candidate& candidate : grid.candidates()) {
    read(candidate.filter, unknown, one_);
    add(one_, stated_, candidate.probability);
  }
}

void StartSpread::add_to(TrackState& state) const {
  widen(state.sd_q, q_);
  widen(state.sd_qd, qd_);
  widen(state.sd_base, base_);
  widen(state.sd_tool_position, tool_position_);
  widen(state.sd_tool_rotation, tool_rotation_);
}

}  // namespace kinfer::track
