// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/filter/mean_rates.hpp"

#include <algorithm>
#include <utility>

namespace kinfer::track {

namespace {

constexpr Index base_rates = 3;

/// [1] c of the header.
double part_missed(int rows) {
  const double n = std::max(1, rows);
  return 1.0 / 12.0 + (1.0 - 1.0 / (n * n)) / 24.0;
}

}  // namespace

MeanRates::MeanRates(const FilterModel& model)
    : rates_(VectorXd::Zero(base_rates + model.layout.positions)), before_(rates_), change_(rates_) {}

void MeanRates::take_rates(const FilterModel& model, const ChainState& state) {
  std::swap(rates_, before_);
  rates_.head<base_rates>() = state.rate;
  for (Index i = 0; i < model.layout.positions; ++i) rates_[base_rates + i] = state.joints[position_states * i + 1];
}

void MeanRates::add_missed(const FilterModel& model, const ChainState& state, double dt, int rows, VectorXd& error) {
  take_rates(model, state);
  if (!has_rates_) {
    has_rates_ = true;
    return;
  }
  const double missed = part_missed(rows) * dt;
  const auto missed_since = [&](Index i) {
    const double change = rates_[i] - before_[i], more = change - change_[i];
    change_[i] = change;
    return has_change_ ? missed * more : 0.0;
  };
  for (Index i = 0; i < base_rates; ++i)
    if (const double more = missed_since(i); state.base == BaseMode::moving) error[BaseIndex::attitude + i] -= more;
  for (Index i = 0; i < model.layout.positions; ++i)
    if (const double more = missed_since(base_rates + i); !model.positions[static_cast<std::size_t>(i)].is_measured)
      error[model.layout.joint_state(i)] -= more;
  has_change_ = true;
}

}  // namespace kinfer::track
