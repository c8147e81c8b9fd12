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
  usual_ = recent_ = now_ = 0.0;
  begin_.reset();
  noticed_.reset();
}

void TurnWatch::settle(double time) {
  noticed_.reset();
  settled_ = time;
}

/// What all sensors have shown at most, until some seconds ago.
void TurnWatch::remember(double time) {
  now_ = std::max(now_, most_);
  if (time - bucket_ < turn_patience) return;
  usual_ = std::max(usual_ * std::exp(-(time - bucket_) / turn_memory), recent_);
  recent_ = now_;
  now_ = 0.0;
  bucket_ = time;
}

void TurnWatch::add(const ChainFilter& filter, double time, double length) {
  if (!begin_) begin_ = bucket_ = settled_ = time;
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
  remember(time);
  const bool is_watched = time - *begin_ > long_mean && time - settled_ > settling;
  if (!noticed_ && is_watched && most_ > std::max(turn_evidence, turn_stands_out * usual_)) noticed_ = time;
}

std::optional<double> TurnWatch::noticed(double time) const {
  return noticed_ && time - *noticed_ > turn_patience ? noticed_ : std::nullopt;
}

}  // namespace kinfer::track
