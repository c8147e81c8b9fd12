// SPDX-License-Identifier: Apache-2.0
// How a tracker starts, and how it finds positions that only motion shows.
#include <algorithm>
#include <cmath>

#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/start/thresholds.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::track {

/// The posture is that at the mean time of the first rows; the blocks behind it are processed like all that follow.
/// Without them the joints' accelerations would be unknown for half of that time (0.2° in each position).
void Tracker::wait_for_start() {
  waiting_.push_back(block_.mean());
  if (waiting_.back().time - waiting_.front().time + waiting_.back().length < start_length) return;
  try_start();
  if (state_.started)
    for (const BlockMeasurement& block : waiting_)
      if (block.time > filter_.state().time) process_block(block);
  waiting_.clear();
}

void Tracker::try_start() {
  const BlockMeasurement block = mean_of(waiting_);
  const auto measures = [](const BlockSample& s) { return s.force_count > 0 && s.rate_count > 0; };
  if (std::ranges::none_of(block.sensors, measures)) return;
  // Every joint is placed by how gravity lies in the base; without it all would be wrong together.
  const int base = model_->bodies.front().sensor;
  if (base >= 0 && block.sensors[static_cast<std::size_t>(base)].force_count == 0) return;
  base_.add(block, filter_);
  const FilterModel turned = turned_model(*model_, filter_.state());
  InitialPosture posture = initial_posture(turned, block, guesses_, base_.mode());
  if (!waits_since_) waits_since_ = block.time;
  const bool is_rough = std::ranges::any_of(posture.positions, &StartPosition::is_rough);
  if (is_rough && block.time - *waits_since_ < start_patience) return;
  waits_since_.reset();
  settle(posture, filter_, waiting_);
  if (!restarted_) {
    weigh_biases(posture);
    place_axes(block);
    posture = initial_posture(turned_model(*model_, filter_.state()), block, guesses_, base_.mode());
    settle(posture, filter_, waiting_);
  }
  start_in(posture, filter_);
  follow_turns(posture, block, guesses_, filter_);
  if (!filter_.counts_from_start())
    for (const UnknownZero& zero : model_->unknown_zeros)
      filter_.count_from_start(zero.position, guesses_[static_cast<std::size_t>(zero.position)].stated, given_start_sd);
  positions_.begin(*model_, posture, filter_.state().base);
  fusion_.reset();
  begin_grid();
  replay_.begin(filter_);
  spread_tool();
  state_.started = true;
  now_ = filter_.state();
  list_wrong_starts(posture);
}

/// Biases that are those of the identification are known better than others.
void Tracker::weigh_biases(const InitialPosture& posture) {
  const ChainFilter before = filter_;
  model_ = std::make_shared<FilterModel>(with_power_up(*model_, change_of_biases(*model_, filter_, posture, waiting_)));
  filter_ = ChainFilter(model_);
  filter_.judge_as(before);
}

/// Axes on the base that may be anywhere on a cone are where the first rows have gravity on both sides of them, if the
/// positions count from here: errors of the cone's size are beyond linearisation.
void Tracker::place_axes(const BlockMeasurement& block) {
  const FilterModel& model = *model_;
  if (model.unknown_axes.empty()) return;
  const InitialPosture posture = initial_posture(model, block, guesses_, base_.mode());
  const auto force = [&](const InsBody& body) -> std::optional<Vec3> {
    if (body.sensor < 0 || block.sensors[static_cast<std::size_t>(body.sensor)].force_count == 0) return {};
    const auto s = static_cast<std::size_t>(body.sensor);
    return block.sensors[s].force - model.sensors[s].accelerometer_bias;
  };
  for (const UnknownAxis& axis : model.unknown_axes) {
    const InsBody& body = model.bodies[axis.body];
    const Index position = model.layout.position[axis.body];
    const std::optional<Vec3> on_base = force(model.bodies.front()), beyond = force(body);
    if (!on_base || !beyond || posture.positions[static_cast<std::size_t>(position)].is_known) continue;
    const double q = posture.state.joints[position_states * position];
    filter_.place_axis(axis.body, body.parent_R_axis.transpose() * *on_base,
                       rot_z(q) * (body.child_R_axis.transpose() * *beyond));
  }
}

void Tracker::list_wrong_starts(const InitialPosture& posture) {
  wrong_starts_.clear();
  for (std::size_t i = 0; i < posture.positions.size(); ++i)
    if (const double odds = posture.positions[i].contradicts_given; odds > 0.0)
      wrong_starts_.push_back({.kind = TrackAlarmKind::start_wrong,
                               .joint = model_positions_[i].joint,
                               .since = now_.time,
                               .strength = odds / wrong_start_log_odds});
}

void Tracker::resolve_start(const BlockMeasurement& block) {
  const std::size_t body = grid_->body();
  grid_->update(block, grid_->is_of_limb() ? filter_.shows_turn(*model_->unknown_turn(body))
                                           : motion_.moves_parent(*model_, body));
  filter_ = grid_->stated();
  if (!grid_->is_decided()) {
    const double patience = grid_->entropy() > open_entropy ? untold_patience : undecided_patience;
    const bool may_count = grid_->motion() != JointMotion::prismatic;
    if (may_count && block.time - grid_->untold_since() > patience) give_up_grid(block.time);
    return;
  }
  if (!grid_->is_of_limb()) positions_.decide(*model_, body);
  grid_.reset();
  forget_places();
  begin_grid();
  replay_.begin(filter_);
}

/// What seemed to be motion was none, or is over: the position counts from where it seems to be, as before.
void Tracker::give_up_grid(double time) {
  if (grid_->is_of_limb())
    filter_.forget_turn(grid_->body());
  else
    filter_.count_from_here(grid_->position());
  grid_.reset();
  suspicion_from_ = time + suspicion_again;
  forget_places();
  replay_.begin(filter_);
}

void Tracker::free_base(ChainFilter& filter) const {
  filter.set_base(BaseMode::moving);
  for (std::size_t b = 1; b < model_->bodies.size(); ++b)
    if (positions_.has_open_heading(*model_, b))
      filter.free_heading(b, heading_sd(*model_, b, guesses_, filter.up_in_ball(b)));
}

/// The base has moved for a while; what counted from the start becomes observable.
void Tracker::let_base_move() {
  replay([this](ChainFilter& filter) { free_base(filter); });
  positions_.let_base_move(*model_);
  begin_grid();
}

/// The same wherever the position stands that the grid is of: its places stay open.
void Tracker::let_base_move_in_grid() {
  free_base(filter_);
  for (StartGrid::Candidate& candidate : grid_->candidates()) free_base(candidate.filter);
  positions_.let_base_move(*model_);
  place_fits_.reset();
  forget_places();
  replay_.begin(filter_);
}

/// Points that a still base left open, once the base moves and all that they are multiplied with is known.
bool Tracker::shows_points() const {
  if (grid_ || filter_.state().base == BaseMode::still) return false;
  return std::ranges::all_of(model_->unknown_turns, [&](const UnknownTurn& t) { return filter_.knows_turn(t.body); }) &&
         std::ranges::all_of(model_->unknown_points, [&](const UnknownPoint& point) {
           const Index at = model_->layout.position[point.body];
           return at < 0 || positions_[static_cast<std::size_t>(at)].is_known;
         });
}

/// The first body of a limb whose turn shows, since the base is tilted and it is known where its segment points; 0:
/// none.
std::size_t Tracker::first_unknown_limb() const {
  for (const UnknownTurn& turn : model_->unknown_turns) {
    const auto position = static_cast<std::size_t>(model_->layout.position[turn.segment]);
    if (!filter_.knows_turn(turn.body) && positions_[position].is_known && filter_.shows_turn(turn)) return turn.body;
  }
  return 0;
}

/// A grid along a joint that gives way to another one: the position is as uncertain as its places are.
void Tracker::widen_by_places() {
  if (!grid_) return;
  const Index state = model_->layout.joint_state(grid_->position());
  filter_.widen(state, MatrixXd::Constant(1, 1, grid_->variance() - filter_.covariance()(state, state)));
}

/// Where it may be: anywhere in its range, or near where motion has shown it to be, if that is less.
void Tracker::begin_grid_along(std::size_t body) {
  place_fits_.reset();
  const Index position = model_->layout.position[body], state = model_->layout.joint_state(position);
  PositionGuess guess = guesses_[static_cast<std::size_t>(position)];
  const double reach = 3.0 * std::sqrt(filter_.covariance()(state, state));
  if (reach < guess.sd) guess.value = filter_.state().joints[position_states * position], guess.sd = reach;
  if (2.0 * guess.sd < prismatic_step)
    positions_.decide(*model_, body);
  else
    grid_ = StartGrid::along(filter_, body, guess);
}

/// Of the first joint position that motion shows from now on, or `share` of certain motion. A revolute one goes before
/// one along a joint: while it stands where it does by chance, a filter that believes in it is soon beyond repair.
void Tracker::begin_grid(double share) {
  if (grid_ && model_->bodies[grid_->body()].motion == JointMotion::revolute) return;
  const auto is_told = [&](std::size_t b) { return motion_.tells_of(*model_, b, share); };
  if (const std::size_t turns = positions_.first_open(*model_, JointMotion::revolute, is_told); turns > 0) {
    widen_by_places();
    grid_ = StartGrid::around(filter_, turns, positions_[static_cast<std::size_t>(model_->layout.position[turns])]);
  } else if (const std::size_t limb = first_unknown_limb(); limb > 0) {
    widen_by_places();
    grid_ = StartGrid::of_limb(filter_, limb);
  } else if (const std::size_t slides = positions_.first_open(*model_, JointMotion::prismatic, is_told);
             slides > 0 && !grid_) {
    begin_grid_along(slides);
  }
}

}  // namespace kinfer::track
