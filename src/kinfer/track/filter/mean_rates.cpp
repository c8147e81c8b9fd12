// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/mean_rates.hpp"

#include <algorithm>

namespace kinfer::track {
namespace {

/// [1] c of the header.
double part_missed(int rows) {
  const double n = std::max(1, rows);
  return 1.0 / 12.0 + (1.0 - 1.0 / (n * n)) / 24.0;
}

}  // namespace

MeanRates::MeanRates(const FilterModel& model)
    : rates_(VectorXd::Zero(model.layout.positions)), accelerations_(rates_) {}

void MeanRates::add_missed(const FilterModel& model, const ChainState& state, double dt, int rows, VectorXd& error) {
  const double missed = part_missed(rows) * dt * dt;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    if (model.bodies[b].motion != JointMotion::revolute) continue;
    const Index i = model.layout.position[b];
    const double rate = state.joints[position_states * i + 1], acceleration = (rate - rates_[i]) / dt;
    if (has_accelerations_) error[model.layout.joint_state(i)] -= missed * (acceleration - accelerations_[i]);
    rates_[i] = rate, accelerations_[i] = acceleration;
  }
  has_accelerations_ = has_rates_;
  has_rates_ = true;
}

}  // namespace kinfer::track
