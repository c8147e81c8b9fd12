// SPDX-License-Identifier: Apache-2.0
// What a tracker states after each row: positions with standard deviations, and alarms.
#include <algorithm>
#include <cmath>

#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/readout/readout.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::track {

/// Positions whose zero is not known; the grid has the spread of its own.
void Tracker::widen_unknown() {
  const Index in_grid = grid_ ? grid_->position() : -1;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const int q = model_positions_[i].q;
    if (q < 0 || static_cast<Index>(i) == in_grid) continue;
    chain_state_.sd_q[q] = std::hypot(chain_state_.sd_q[q], positions_[i].missing_sd());
  }
  if (grid_) spread_.add_to(chain_state_);
}

void Tracker::read_out(double time) {
  now_ = filter_.state();
  if (time > now_.time) predict_mean(*model_, time - now_.time, now_);
  track::read_out(*tracking_, *model_, now_, filter_.covariance(), chain_state_);
  tool_.place(*model_, now_);
  for (std::size_t s = 0; s < state_.innovation.size(); ++s) state_.innovation[s] = fit_.sensor(s).quick;
  for (JointStatus& joint : chain_state_.joints) {
    joint.source = JointSource::chain;
    joint.reference = JointReference::chain;
  }
  const Index in_grid = grid_ ? grid_->position() : -1;  // as uncertain as its places are apart
  for (std::size_t i = 0; i < positions_.size(); ++i)
    if (model_positions_[i].joint >= 0 &&
        (positions_[i].is_relative || (!positions_[i].is_known && static_cast<Index>(i) != in_grid)))
      chain_state_.joints[static_cast<std::size_t>(model_positions_[i].joint)].reference = JointReference::start;
  chain_state_.time = time;
  chain_state_.base_T_tool = tool_.tool();
  chain_state_.sd_tool_position = tool_.position_sd();
  chain_state_.sd_tool_rotation = tool_.rotation_sd();
  widen_unknown();
  take_estimates(chain_state_, state_);
  for (std::size_t s = 0; s < is_sound_.size(); ++s)
    is_sound_[s] = !does_not_fit_[s] && !turned_[s] && health_[s].measures() && !health_[s].instrument_missing &&
                   !return_.waits_for(s);
  is_settled_.assign(is_settled_.size(), true);
  for (std::size_t i = 0; i < positions_.size(); ++i)
    if (positions_[i].is_open) is_settled_[static_cast<std::size_t>(model_positions_[i].joint)] = false;
  // Single sensors know nothing of how limbs are turned on their segments.
  for (const UnknownTurn& turn : model_->unknown_turns)
    if (filter_.knows_turn(turn.body) || filter_.tilt_of(turn) > 0.0)
      is_settled_[static_cast<std::size_t>(tracking_->bodies[turn.body].joint)] = false;
  // Nor of how axes lie on the base.
  for (const UnknownAxis& axis : model_->unknown_axes)
    is_settled_[static_cast<std::size_t>(tracking_->bodies[axis.body].joint)] = false;
  state_headings();
  fusion_.apply(*tracking_, composed_, {.is_sound = is_sound_, .is_settled = is_settled_, .heading_sd = heading_sd_},
                state_);
}

/// Of spherical joints whose heading motion shows; one that it has not shown yet is not settled.
void Tracker::state_headings() {
  for (std::size_t b = 1; b < model_->bodies.size(); ++b) {
    if (!motion_shows_heading(*model_, b)) continue;
    const auto joint = static_cast<std::size_t>(tracking_->bodies[b].joint);
    const bool is_relative = state_.joints[joint].reference == JointReference::start;
    heading_sd_[joint].reset();
    if (!is_relative) heading_sd_[joint] = std::sqrt(std::max(0.0, filter_.heading_variance(b)));
    if (filter_.considers_heading(b)) is_settled_[joint] = false;
  }
}

void Tracker::list_alarms(double time) {
  auto& alarms = state_.alarms;
  alarms.clear();
  if (restarted_ && time - *restarted_ < clipped_memory)
    alarms.push_back({.kind = TrackAlarmKind::restarted, .since = *restarted_});
  for (const TrackAlarm& alarm : wrong_starts_)
    if (time - alarm.since < clipped_memory) alarms.push_back(alarm);
  int disagreeing = 0;
  for (std::size_t s = 0; s < does_not_fit_.size(); ++s) {
    const int sensor = static_cast<int>(s);
    add_alarms(health_[s], sensor, alarms);
    if (const auto since = biases_.named_since(s); since && !does_not_fit_[s])
      alarms.push_back({.kind = TrackAlarmKind::sensor_moved,
                        .sensor = sensor,
                        .since = *since,
                        .strength = bias_strength(filter_, s)});
    if (const auto& found = exchange_.found(); found && (s == found->first || s == found->second))
      alarms.push_back({.kind = TrackAlarmKind::sensor_exchanged, .sensor = sensor, .since = found->since});
    if (turned_[s] && !does_not_fit_[s])
      alarms.push_back({.kind = TrackAlarmKind::sensor_moved,
                        .sensor = sensor,
                        .since = turned_[s]->since,
                        .strength = turned_[s]->strength,
                        .turn = size_of(mount_turn(filter_, s))});
    if (!does_not_fit_[s]) continue;
    ++disagreeing;
    alarms.push_back({.kind = is_late_[s] ? TrackAlarmKind::sensor_late : TrackAlarmKind::sensor_moved,
                      .sensor = sensor,
                      .since = fit_.sensor(s).since,
                      .strength = fit_.sensor(s).strength});
  }
  for (std::size_t j = 0; j < tracking_->joints.size(); ++j)
    if (filter_.doubts_joint(j))
      alarms.push_back({.kind = TrackAlarmKind::joint_changed,
                        .joint = static_cast<int>(j),
                        .since = fit_.joint(j).since,
                        .strength = fit_.joint(j).strength});
  if (2 * disagreeing >= static_cast<int>(does_not_fit_.size()) && disagreeing > 1)
    alarms.push_back({.kind = TrackAlarmKind::does_not_fit, .since = time});
  else if (misfit_since_)
    alarms.push_back({.kind = TrackAlarmKind::does_not_fit,
                      .since = *misfit_since_,
                      .strength = filter_.levels().common() / misfit_inflation});
}

}  // namespace kinfer::track
