// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/turn_watch.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/square.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Twice the log-likelihood that the likeliest turn gains.
double evidence(const TurnScore& sum) {
  const Mat3 information = sum.information + Mat3::Identity() / square(turned_mount_sd);
  return sum.score.dot(information.inverse() * sum.score);
}

}  // namespace

void TurnWatch::reset() {
  std::ranges::fill(turns_, Turn{});
  usual_ = {};
  noticed_.reset();
  settled_.reset();
}

void TurnWatch::settle(double time) {
  noticed_.reset();
  settled_ = time;
}

void TurnWatch::add(const ChainFilter& filter, double time, double length) {
  const double kept = std::exp(-length / turn_mean);
  double most = 0.0;
  for (std::size_t s = 0; s < turns_.size(); ++s) {
    Turn& turn = turns_[s];
    turn.sum.score *= kept;
    turn.sum.information *= kept;
    if (!filter.uses_sensor(s) || filter.innovations().rows[s] == 0) continue;
    turn.sum.score += filter.innovations().turn[s].score;
    turn.sum.information += filter.innovations().turn[s].information;
    const double now = evidence(turn.sum);
    turn.most = noticed_ ? std::max(turn.most, now) : now;
    most = std::max(most, turn.most);
  }
  most_ = most;
  usual_.add(most_, time);
  const std::optional<double> usual = usual_.value();
  if (noticed_ || !usual || (settled_ && time - *settled_ < settling)) return;
  if (most_ > std::max(turn_evidence, turn_stands_out * *usual)) noticed_ = time;
}

std::optional<double> TurnWatch::noticed(double time) const {
  return noticed_ && time - *noticed_ > turn_patience ? noticed_ : std::nullopt;
}

}  // namespace kinfer::track
