// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinfer/base/expect.hpp"
#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/filter/thresholds.hpp"
#include "kinfer/track/readout/readout.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Index into the model's q of each joint position of the filter; a spherical joint that stands for a loose revolute
/// joint has its rotation about the axis as the third, and no joint position for the others (−1).
std::vector<int> model_positions(const TrackingModel& tracking, const FilterModel& model) {
  std::vector<int> positions;
  for (std::size_t b = 1; b < model.bodies.size(); ++b) {
    const TrackingBody& body = tracking.bodies[b];
    const Index dof = degrees_of_freedom(model.bodies[b].motion);
    if (dof == 0) continue;
    const TrackingJoint& joint = tracking.joints[static_cast<std::size_t>(body.joint)];
    const bool is_second = tracking.bodies[static_cast<std::size_t>(body.parent)].joint == body.joint;
    const bool is_loose = dof == 3 && joint.positions == 1;
    for (int i = 0; i < static_cast<int>(dof); ++i)
      positions.push_back(is_loose ? (i == 2 ? joint.first_position : -1)
                                   : joint.first_position + i + (is_second ? 1 : 0));
  }
  return positions;
}

const TrackingJoint& joint_of(const TrackingModel& tracking, int position) {
  return *std::ranges::find_if(tracking.joints, [&](const TrackingJoint& joint) {
    return position >= joint.first_position && position < joint.first_position + joint.positions;
  });
}

std::vector<PositionGuess> make_guesses(const TrackingModel& tracking, const std::vector<int>& positions,
                                        const TrackOptions& options) {
  std::vector<PositionGuess> guesses;
  for (const int position : positions) {
    PositionGuess guess{.value = 0.0, .sd = max_position_sd};
    if (position >= 0) {
      const TrackingJoint& joint = joint_of(tracking, position);
      const auto at = static_cast<std::size_t>(position - joint.first_position);
      if (at < joint.range.size()) {
        guess.value = 0.5 * (joint.range[at].lower + joint.range[at].upper);
        guess.sd = 0.5 * (joint.range[at].upper - joint.range[at].lower) + start_prismatic_margin;
      }
      if (options.start && position < options.start->size() && !std::isnan((*options.start)[position]))
        guess = {.value = (*options.start)[position], .sd = given_start_sd, .is_given = true};
    }
    guesses.push_back(guess);
  }
  return guesses;
}

/// Of a joint with one turning position. One without a range may be anywhere.
LastPosition last_position(const TrackingJoint& joint, const TrackState& state, double time, double acceleration_sd) {
  LastPosition last{.time = time,
                    .value = state.q[joint.first_position],
                    .rate = state.qd[joint.first_position],
                    .sd = state.sd_q[joint.first_position],
                    .most_turned = max_position_sd,
                    .speed = std::numeric_limits<double>::infinity(),
                    .acceleration_sd = acceleration_sd};
  if (joint.range.empty()) return last;
  const auto& seen = joint.range.front();
  last.speed = seen.speed;
  last.most_turned = std::min(max_position_sd, 0.5 * (seen.upper - seen.lower));
  return last;
}

std::optional<BaseMode> given_base(BaseMotion motion) {
  if (motion == BaseMotion::automatic) return {};
  return motion == BaseMotion::moving ? BaseMode::moving : BaseMode::still;
}

}  // namespace

Tracker::Tracker(const TrackingModel& model, const TrackOptions& options)
    : tracking_(std::make_shared<TrackingModel>(model)),
      model_(std::make_shared<FilterModel>(filter_model(model))),
      model_position_(model_positions(model, *model_)),
      joint_of_position_(model_position_),
      filter_(model_),
      motion_(*model_),
      spread_(model, *model_),
      unknown_(model_->bodies.size(), 0.0),
      block_(model.sensors.size()),
      rest_(*model_),
      base_(model, *model_, given_base(options.base)),
      health_(model.sensors.size()),
      fit_(model.sensors.size(), model.joints.size()),
      clocks_(model.sensors.size()),
      replay_(filter_),
      does_not_fit_(model.sensors.size(), false),
      is_late_(model.sensors.size(), false),
      biases_(model.sensors.size()),
      composed_(model, options),
      is_sound_(model.sensors.size(), true),
      is_settled_(model.joints.size(), true),
      fusion_(model),
      tool_(*model_, model.tool),
      now_(initial_state(*model_)),
      chain_state_(unknown_state(model)),
      state_(unknown_state(model)) {
  guesses_ = make_guesses(model, model_position_, options);
  for (int& position : joint_of_position_)
    if (position >= 0) position = static_cast<int>(&joint_of(*tracking_, position) - tracking_->joints.data());
  is_known_.assign(joint_of_position_.size(), false);
  is_open_ = is_known_;
  start_sd_ = lost_in_gap_ = std::vector<double>(joint_of_position_.size(), 0.0);
  state_.alarms.reserve(4 * model.sensors.size() + model.joints.size() + 4);
}

/// After a gap the posture is unknown again; what was learnt of the sensors is kept. A position that nothing shows then
/// goes on from where it was, as uncertain as it may have moved meanwhile.
void Tracker::restart(double time) {
  if (state_.started) {
    restarted_ = time;
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      if (joint_of_position_[i] < 0) continue;
      const TrackingJoint& joint = tracking_->joints[static_cast<std::size_t>(joint_of_position_[i])];
      if (joint.positions != 1 || joint.type == EstimatedJointType::prismatic) continue;  // these have a grid of starts
      guesses_[i].last = last_position(joint, state_, last_time_, model_->positions[i].sd);
    }
    forget_state();
  }
  for (auto& guess : guesses_) guess.is_given = false;
  state_.started = false;
  grid_.reset();
  return_.reset();
  motion_.reset();
  block_.clear();
  waiting_.clear();
  waits_since_.reset();
  fit_.reset();
  std::ranges::fill(biases_, BiasChange{});
}

/// Whether what has happened in a gap [s] is too much for the filter to go on.
bool Tracker::is_lost_after(double gap) const {
  if (gap <= shortest_restart_gap || !state_.started) return gap > restart_gap;
  double most = 0.0;  // [rad/s²]
  for (std::size_t b = 1; b < model_->bodies.size(); ++b)
    if (model_->bodies[b].motion == JointMotion::revolute)
      most = std::max(most, std::abs(filter_.state().joints[position_states * model_->layout.position[b] + 2]));
  return gap > restart_gap || 0.5 * most * gap * gap > turned_in_gap;
}

/// Nothing is known until the next start; alarms stay.
void Tracker::forget_state() {
  std::vector<TrackAlarm> alarms = std::move(state_.alarms);
  state_ = unknown_state(*tracking_);
  state_.alarms = std::move(alarms);
}

void Tracker::add(const InsRow& row) {
  KINFER_EXPECT(row.sensors.size() == tracking_->sensors.size());
  if (has_rows_ && is_lost_after(row.time - last_time_)) restart(row.time);
  has_rows_ = true;
  last_time_ = row.time;
  health_.add(row);
  composed_.add(row);
  choose_sensors();
  if (block_.ends_before(row.time)) end_block();
  block_.add(row);
  if (block_.is_complete(update_period)) end_block();
  if (rest_.add(row) && state_.started) correct_in_rest();
  state_.time = row.time;
  if (state_.started) read_out(row.time);
  list_alarms(row.time);
}

void Tracker::correct_in_rest() {
  rest_.correct(filter_);
  if (!grid_) return;
  for (StartGrid::Candidate& candidate : grid_->candidates()) rest_.correct(candidate.filter);
}

void Tracker::end_block() {
  if (state_.started)
    process_block(block_.mean());
  else
    wait_for_start();
  block_.clear();
}

/// Sensors that are lost, stuck or disagree are left out.
void Tracker::choose_sensors() {
  for (std::size_t s = 0; s < does_not_fit_.size(); ++s) {
    const bool is_used = !does_not_fit_[s] && !health_[s].lost && !health_[s].stuck;
    if (is_used == (filter_.uses_sensor(s) || return_.waits_for(s))) continue;
    if (is_used) {
      take_in(s);
      continue;
    }
    return_.drop(s, filter_);
    filter_.use_sensor(s, false);
    if (health_[s].stuck && state_.started && !grid_) replay([](ChainFilter&) {});  // it was believed until now
  }
}

/// What it showed while it was out of use says nothing, and is not averaged with what it shows now. Where joints beside
/// it have moved unseen they are found first.
void Tracker::take_in(std::size_t sensor) {
  fit_.reset_sensor(sensor);
  block_.clear();
  if (state_.started && !grid_ && has_lost_position(filter_, sensor))
    return_.begin(sensor, filter_);
  else
    filter_.use_sensor(sensor, true);
}

/// A position that is not found, although its sensors measure, counts from where it seems to be, as at a start.
void Tracker::find_returned(const BlockMeasurement& block) {
  if (!return_.is_waiting()) return;
  const std::optional<FoundAgain> found = return_.add(block);
  if (!found) return;
  filter_ = found->filter;
  for (const FoundPosition& at : found->positions) {
    const auto i = static_cast<std::size_t>(at.position);
    is_known_[i] = at.sd < turned_in_gap;
    lost_in_gap_[i] = is_known_[i] ? 0.0 : std::min(max_position_sd, at.sd);
    is_open_[i] = !is_known_[i] && filter_.state().base == BaseMode::moving;
    start_sd_[i] = lost_in_gap_[i];
    if (is_known_[i]) continue;
    if (filter_.state().base == BaseMode::moving)
      filter_.place(at.position, filter_.state().joints[position_states * at.position], 0.0);
    else
      filter_.declare_known(at.position);
  }
  return_.begin_again(filter_);
  begin_grid();
  replay_.begin(filter_);
}

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
  InitialPosture posture = initial_posture(*model_, block, guesses_, base_.mode());
  if (!waits_since_) waits_since_ = block.time;
  const bool is_rough = std::ranges::any_of(posture.positions, &StartPosition::is_rough);
  if (is_rough && block.time - *waits_since_ < start_patience) return;
  waits_since_.reset();
  settle(posture, filter_, waiting_);
  start_in(posture, filter_);
  open_positions(posture);
  fusion_.reset();
  begin_grid();
  replay_.begin(filter_);
  spread_tool();
  state_.started = true;
  now_ = filter_.state();
}

/// Whether a body moves whose joint leads to this one: then motion shows how the joint stands, if gravity does not.
bool Tracker::parent_moves(std::size_t b) const {
  if (filter_.state().base == BaseMode::moving) return true;
  for (int a = model_->bodies[b].parent; a > 0; a = model_->bodies[static_cast<std::size_t>(a)].parent)
    if (model_->layout.position[static_cast<std::size_t>(a)] >= 0) return true;
  return false;
}

/// Whether what moves now tells where such a joint stands. A prismatic one is told by the rates that its own axes have.
bool Tracker::tells_of(std::size_t b) const {
  if (model_->bodies[b].motion == JointMotion::prismatic) return true;
  auto parent = static_cast<std::size_t>(model_->bodies[b].parent);
  while (parent > 0 && model_->bodies[parent].sensor < 0)
    parent = static_cast<std::size_t>(model_->bodies[parent].parent);
  const int sensor = model_->bodies[parent].sensor;
  return sensor < 0 || motion_.moves(static_cast<std::size_t>(sensor));
}

void Tracker::open_positions(const InitialPosture& posture) {
  for (std::size_t b = 1; b < model_->bodies.size(); ++b) {
    const JointMotion motion = model_->bodies[b].motion;
    const bool is_loose = model_->is_loose(b);
    for (Index k = 0; k < degrees_of_freedom(motion); ++k) {
      const auto i = static_cast<std::size_t>(model_->layout.position[b] + k);
      const StartPosition& start = posture.positions[i];
      const bool is_seen = filter_.state().base == BaseMode::moving || !start.is_unseen;
      is_known_[i] = start.is_known;
      is_open_[i] = !start.is_known && degrees_of_freedom(motion) == 1 &&
                    (motion == JointMotion::prismatic || (parent_moves(b) && is_seen));
      lost_in_gap_[i] = std::min(max_position_sd, start.lost_sd.value_or(0.0));
      const bool has_zero = start.is_known || start.is_unseen || is_loose || motion == JointMotion::prismatic;
      start_sd_[i] = has_zero ? 0.0 : start.lost_sd ? std::max(start_sd_[i], lost_in_gap_[i]) : max_position_sd;
    }
  }
}

void Tracker::resolve_start(const BlockMeasurement& block) {
  grid_->update(block, tells_of(grid_->body()));
  filter_ = grid_->stated();
  if (!grid_->is_decided()) return;
  const std::size_t body = grid_->body();
  for (Index k = 0; k < degrees_of_freedom(model_->bodies[body].motion); ++k) {
    const auto i = static_cast<std::size_t>(model_->layout.position[body] + k);
    is_known_[i] = true;
    is_open_[i] = false;
    start_sd_[i] = 0.0;
  }
  grid_.reset();
  fit_.reset();  // other places did not fit, which says nothing of the sensors
  begin_grid();
  replay_.begin(filter_);
}

void Tracker::replay(const std::function<void(ChainFilter&)>& prepare) {
  fit_.reset();
  replay_.run(filter_, prepare, [&](const ChainFilter& filter, const BlockMeasurement& past) {
    fit_.add(filter, past.time, past.length);
  });
  if (return_.is_waiting()) return_.begin_again(filter_);
}

/// A base that begins to move looks like a fault of sensors at first.
bool Tracker::base_begins_to_move(const BlockMeasurement& block) {
  if (filter_.state().base == BaseMode::moving) return false;
  base_.add(block, filter_);
  if (fit_.worst(filter_).sensor >= 0) base_.suspect(filter_);
  return base_.mode() == BaseMode::moving;
}

/// The base has moved for a while; what counted from the start becomes observable.
void Tracker::let_base_move() {
  replay([](ChainFilter& filter) { filter.set_base(BaseMode::moving); });
  for (std::size_t b = 1; b < model_->bodies.size(); ++b)
    for (Index k = 0; k < degrees_of_freedom(model_->bodies[b].motion); ++k) {
      const auto i = static_cast<std::size_t>(model_->layout.position[b] + k);
      is_open_[i] = !is_known_[i] && degrees_of_freedom(model_->bodies[b].motion) == 1;
    }
  begin_grid();
}

/// Of the first joint position that motion shows from now on.
void Tracker::begin_grid() {
  for (std::size_t b = 1; b < model_->bodies.size() && !grid_; ++b) {
    const Index at = model_->layout.position[b];
    if (at < 0 || !is_open_[static_cast<std::size_t>(at)] || !tells_of(b)) continue;
    if (model_->bodies[b].motion == JointMotion::prismatic)
      grid_ = StartGrid::along(filter_, b, guesses_[static_cast<std::size_t>(at)]);
    else
      grid_ = StartGrid::around(filter_, b, start_sd_[static_cast<std::size_t>(at)]);
  }
}

/// Where positions count from the start the tool is as uncertain as what they count from.
void Tracker::spread_tool() {
  for (std::size_t b = 1; b < unknown_.size(); ++b) {
    const Index at = model_->layout.position[b];
    const bool is_in_grid = grid_ && grid_->body() == b;
    unknown_[b] = at < 0 || is_in_grid ? 0.0 : start_sd_[static_cast<std::size_t>(at)];
  }
  tool_.spread(*model_, filter_.state(), filter_.covariance(), unknown_);
  if (grid_ && model_->bodies[grid_->body()].motion != JointMotion::prismatic)
    spread_.update(*grid_, unknown_);
  else
    spread_.clear();
}

/// Most sensors at once are far from what the chain explains: another machine's log, permuted axes.
void Tracker::watch_misfit(double time) {
  const double common = filter_.levels().common();
  if (common < fitting_inflation) misfit_since_.reset();
  if (common > misfit_inflation && !misfit_since_) misfit_since_ = time;
}

void Tracker::leave_out(std::size_t sensor) {
  does_not_fit_[sensor] = true;
  is_late_[sensor] = clocks_.is_late(sensor, lateness_share);
  const Agreement named = as_named(fit_.sensor(sensor));
  replay([&](ChainFilter& filter) { filter.use_sensor(sensor, false); });
  fit_.set_sensor(sensor, named);
}

void Tracker::doubt(std::size_t joint) {
  const Agreement named = as_named(fit_.joint(joint));
  replay([&](ChainFilter& filter) { filter.doubt_joint(joint, true); });
  fit_.set_joint(joint, named);
}

/// What disagrees most is left out, as if it had never been believed, and what agrees again is taken in.
void Tracker::examine_fit() {
  const Suspect worst = fit_.worst(filter_);
  if (worst.sensor >= 0) leave_out(static_cast<std::size_t>(worst.sensor));
  if (worst.joint >= 0) doubt(static_cast<std::size_t>(worst.joint));
  const Suspect back = fit_.recovered(filter_);
  if (back.sensor >= 0) {
    does_not_fit_[static_cast<std::size_t>(back.sensor)] = is_late_[static_cast<std::size_t>(back.sensor)] = false;
    fit_.reset_sensor(static_cast<std::size_t>(back.sensor));
  }
  if (back.joint >= 0) {
    filter_.doubt_joint(static_cast<std::size_t>(back.joint), false);
    fit_.reset_joint(static_cast<std::size_t>(back.joint));
  }
}

double Tracker::bias_distance(std::size_t sensor) const {
  const InsLevel distance = filter_.bias_distance(sensor);
  return std::max(distance.rate, distance.force);
}

/// Biases that the filter keeps far from where they were handed over: a sensor that changed, or one that stands for a
/// neighbour that turned. Where something else is named already, they follow from that.
void Tracker::watch_biases(double time) {
  bool is_explained = std::ranges::find(does_not_fit_, true) != does_not_fit_.end();
  for (std::size_t j = 0; j < tracking_->joints.size(); ++j) is_explained |= filter_.doubts_joint(j);
  for (std::size_t s = 0; s < biases_.size(); ++s) {
    BiasChange& bias = biases_[s];
    const double distance = bias_distance(s);
    if (distance < (bias.is_named ? bias_recovered : bias_limit))
      bias = {};
    else if (!bias.since)
      bias.since = time;
    bias.is_named |= bias.since && !is_explained && time - *bias.since > settling;
  }
}

void Tracker::process_block(const BlockMeasurement& block) {
  motion_.add(block, filter_);
  if (!grid_) begin_grid();
  if (grid_) {
    resolve_start(block);
  } else {
    filter_.predict(block.time);
    filter_.update(block);
  }
  fit_.add(filter_, block.time, block.length);
  clocks_.add(filter_, block.length);
  for (std::size_t s = 0; s < does_not_fit_.size(); ++s)
    if (does_not_fit_[s] && clocks_.is_late(s, lateness_share_later)) is_late_[s] = true;
  if (!grid_) {
    replay_.add(block, filter_);
    if (base_begins_to_move(block))
      let_base_move();
    else
      examine_fit();
    watch_biases(block.time);
    watch_misfit(block.time);
    find_returned(block);
  }
  spread_tool();
}

/// What is added to the standard deviations of positions whose zero is not known: all of that, where motion will show
/// it; where they count from the start, what they may have turned in a gap.
void Tracker::widen_unknown() {
  for (std::size_t b = 1; b < model_->bodies.size(); ++b) {
    const bool is_in_grid = grid_ && grid_->body() == b;
    for (Index k = 0; k < degrees_of_freedom(model_->bodies[b].motion); ++k) {
      const auto i = static_cast<std::size_t>(model_->layout.position[b] + k);
      if (is_known_[i] || is_in_grid || joint_of_position_[i] < 0) continue;
      double& sd = chain_state_.sd_q[model_position_[i]];
      sd = std::hypot(sd, is_open_[i] ? start_sd_[i] : lost_in_gap_[i]);
    }
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
  for (std::size_t i = 0; i < is_known_.size(); ++i)
    if (!is_known_[i] && joint_of_position_[i] >= 0)
      chain_state_.joints[static_cast<std::size_t>(joint_of_position_[i])].reference = JointReference::start;
  chain_state_.time = time;
  state_.q = chain_state_.q;
  state_.qd = chain_state_.qd;
  chain_state_.base_T_tool = tool_.tool();
  chain_state_.sd_tool_position = tool_.position_sd();
  chain_state_.sd_tool_rotation = tool_.rotation_sd();
  widen_unknown();
  state_.sd_q = chain_state_.sd_q;
  state_.sd_qd = chain_state_.sd_qd;
  state_.joints = chain_state_.joints;
  state_.world_q_base = chain_state_.world_q_base;
  state_.sd_base = chain_state_.sd_base;
  state_.base_T_tool = chain_state_.base_T_tool;
  state_.sd_tool_position = chain_state_.sd_tool_position;
  state_.sd_tool_rotation = chain_state_.sd_tool_rotation;
  for (std::size_t s = 0; s < is_sound_.size(); ++s)
    is_sound_[s] = !does_not_fit_[s] && !health_[s].lost && !health_[s].stuck && !health_[s].instrument_missing &&
                   !return_.waits_for(s);
  is_settled_.assign(is_settled_.size(), true);
  for (std::size_t i = 0; i < is_open_.size(); ++i)
    if (is_open_[i]) is_settled_[static_cast<std::size_t>(joint_of_position_[i])] = false;
  fusion_.apply(*tracking_, composed_, {.is_sound = is_sound_, .is_settled = is_settled_}, state_);
}

void Tracker::list_alarms(double time) {
  auto& alarms = state_.alarms;
  alarms.clear();
  if (restarted_ && time - *restarted_ < clipped_memory)
    alarms.push_back({.kind = TrackAlarmKind::restarted, .since = *restarted_});
  int disagreeing = 0;
  for (std::size_t s = 0; s < does_not_fit_.size(); ++s) {
    const int sensor = static_cast<int>(s);
    const SensorHealth& health = health_[s];
    if (health.lost)
      alarms.push_back({.kind = TrackAlarmKind::sensor_lost, .sensor = sensor, .since = health.lost_since});
    else if (health.instrument_lost)
      alarms.push_back({.kind = TrackAlarmKind::sensor_lost, .sensor = sensor, .since = health.instrument_lost_since});
    if (health.stuck)
      alarms.push_back({.kind = TrackAlarmKind::sensor_stuck, .sensor = sensor, .since = health.stuck_since});
    if (health.clipped)
      alarms.push_back({.kind = TrackAlarmKind::sensor_clipped, .sensor = sensor, .since = health.last_clipped});
    if (biases_[s].is_named && !does_not_fit_[s])
      alarms.push_back({.kind = TrackAlarmKind::sensor_moved,
                        .sensor = sensor,
                        .since = *biases_[s].since,
                        .strength = bias_distance(s) / bias_limit});
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
