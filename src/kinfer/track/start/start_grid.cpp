// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/start_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/square.hpp"
#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {

StartGrid::StartGrid(const ChainFilter& filter, std::size_t body, bool is_of_limb)
    : body_(body),
      is_of_limb_(is_of_limb),
      motion_(is_of_limb ? JointMotion::revolute : filter.model().bodies[body].motion),
      position_(filter.model().layout.position[body]),
      state_(is_of_limb ? filter.model().unknown_turn(body)->state : filter.model().layout.joint_state(position_)),
      untold_since_(filter.state().time) {}

StartGrid StartGrid::around(const ChainFilter& filter, std::size_t body, const KnownPosition& known) {
  StartGrid grid(filter, body);
  const double q = filter.state().joints[position_states * grid.position_],
               step = 2.0 * std::numbers::pi / start_places;
  const bool was_known = known.start_sd < max_position_sd;
  for (int k = 0; k < start_places; ++k) {
    const double turn = wrap_to_pi(k * step);
    grid.candidates_.push_back({.filter = filter});
    Candidate& candidate = grid.candidates_.back();
    if (known.is_relative && !was_known)
      candidate.filter.turn_start(grid.position_, turn, 0.5 * step, known.lost_sd);
    else
      candidate.filter.place(grid.position_, q + turn, 0.5 * step);
    candidate.filter.keep_gravity(body, turn);
    if (was_known) candidate.log_weight = -0.5 * square(turn / std::max(known.start_sd, 0.5 * step));
  }
  grid.candidates_.front().is_stated = true;
  grid.number();
  grid.weigh();
  return grid;
}

StartGrid StartGrid::of_limb(const ChainFilter& filter, std::size_t body) {
  StartGrid grid(filter, body, true);
  const double step = 2.0 * std::numbers::pi / start_places;
  for (int k = 0; k < start_places; ++k) {
    grid.candidates_.push_back({.filter = filter});
    grid.candidates_.back().filter.turn_limb(body, wrap_to_pi(k * step), 0.5 * step);
  }
  grid.candidates_.front().is_stated = true;
  grid.number();
  grid.weigh();
  return grid;
}

StartGrid StartGrid::along(const ChainFilter& filter, std::size_t body, const PositionGuess& guess) {
  StartGrid grid(filter, body);
  const double step = std::max(prismatic_step, 2.0 * guess.sd / (start_places - 1));
  const int places = 1 + static_cast<int>(2.0 * guess.sd / step);
  for (int k = 0; k < places; ++k) {
    grid.candidates_.push_back({.filter = filter});
    grid.candidates_.back().filter.place(grid.position_, guess.value - guess.sd + k * step, 0.5 * step);
  }
  grid.candidates_[static_cast<std::size_t>(places / 2)].is_stated = true;
  grid.number();
  grid.weigh();
  return grid;
}

void StartGrid::number() {
  for (std::size_t k = 0; k < candidates_.size(); ++k) candidates_[k].place = k;
}

void StartGrid::update(const BlockMeasurement& block, bool tells) {
  const bool has_settled = updates_ >= start_updates;
  if (tells) untold_since_ = block.time;
  for (Candidate& candidate : candidates_) {
    candidate.filter.predict(block.time);
    candidate.filter.update(block);
    if (tells && has_settled) candidate.log_weight += candidate.filter.innovations().log_likelihood;
  }
  if (++updates_ <= start_updates) return;
  drop_unlikely();
  merge();
  weigh();
  choose();
}

void StartGrid::drop_unlikely() {
  const double most = std::ranges::max_element(candidates_, {}, &Candidate::log_weight)->log_weight;
  std::erase_if(candidates_, [&](const Candidate& c) { return c.log_weight < most - start_log_odds; });
}

/// Candidates that have converged to one place are one, as likely as all of them.
void StartGrid::merge() {
  std::ranges::stable_sort(candidates_, std::greater<>{}, &Candidate::log_weight);
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    for (std::size_t j = candidates_.size() - 1; j > i; --j) {
      Candidate &kept = candidates_[i], &other = candidates_[j];
      if (distance(kept.filter, other.filter) >= start_merge) continue;
      kept.log_weight += std::log1p(std::exp(other.log_weight - kept.log_weight));
      kept.is_stated |= other.is_stated;
      candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(j));
    }
}

void StartGrid::weigh() {
  const double most = std::ranges::max_element(candidates_, {}, &Candidate::log_weight)->log_weight;
  double sum = 0.0;
  for (const Candidate& c : candidates_) sum += std::exp(c.log_weight - most);
  for (Candidate& c : candidates_) c.probability = std::exp(c.log_weight - most) / sum;
}

double StartGrid::entropy() const {
  double sum = 0.0;
  for (const Candidate& c : candidates_)
    if (c.probability > 0.0) sum -= c.probability * std::log(c.probability);
  return sum;
}

/// Mean squared distance of the position from that of a candidate.
double StartGrid::variance_about(const Candidate& candidate) const {
  double variance = 0.0;
  for (const Candidate& c : candidates_) {
    variance += c.probability * (c.filter.covariance()(state_, state_) + square(distance(c.filter, candidate.filter)));
  }
  return variance;
}

/// Displacements are near each other, and their places hard to tell apart: one that is stated stays, as long as it is
/// possible, so that the position does not jump.
void StartGrid::choose() {
  const auto by_variance = [&](const Candidate& c) { return variance_about(c); };
  const auto best = std::ranges::min_element(candidates_, {}, by_variance);
  const auto now = std::ranges::find_if(candidates_, &Candidate::is_stated);
  const bool is_possible = now != candidates_.end();
  if (is_possible && motion_ == JointMotion::prismatic) return;
  if (is_possible && 2.0 * variance_about(*best) > variance_about(*now)) return;
  if (is_possible) now->is_stated = false;
  best->is_stated = true;
}

const ChainFilter& StartGrid::stated() const {
  return std::ranges::find_if(candidates_, &Candidate::is_stated)->filter;
}

double StartGrid::variance() const {
  return variance_about(*std::ranges::find_if(candidates_, &Candidate::is_stated));
}

double StartGrid::value(const ChainFilter& filter) const {
  return is_of_limb_ ? filter.state().turned[static_cast<Index>(body_)]
                     : filter.state().joints[position_states * position_];
}

double StartGrid::distance(const ChainFilter& a, const ChainFilter& b) const {
  const double d = value(a) - value(b);
  return std::abs(motion_ == JointMotion::revolute ? wrap_to_pi(d) : d);
}

}  // namespace kinfer::track
