// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/model/thresholds.hpp"
#include "kinfer/track/readout/readout.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

std::optional<BaseMode> given_base(BaseMotion motion) {
  if (motion == BaseMotion::automatic) return {};
  return motion == BaseMotion::moving ? BaseMode::moving : BaseMode::still;
}

}  // namespace

Tracker::Tracker(const TrackingModel& model, const TrackOptions& options)
    : tracking_(std::make_shared<TrackingModel>(model)),
      model_(std::make_shared<FilterModel>(filter_model(model))),
      model_positions_(model_positions(model, *model_)),
      guesses_(position_guesses(model, *model_, model_positions_, options.start)),
      filter_(model_),
      motion_(*model_),
      spread_(model, *model_),
      unknown_(model_->bodies.size(), 0.0),
      positions_(*model_),
      block_(model.sensors.size()),
      rest_(*model_),
      base_(model, *model_, given_base(options.base)),
      health_(model.sensors.size()),
      fit_(model.sensors.size(), model.joints.size()),
      place_fits_(model.sensors.size(), model.joints.size()),
      clocks_(model.sensors.size()),
      turns_(model.sensors.size()),
      replay_(filter_),
      does_not_fit_(model.sensors.size(), false),
      is_late_(model.sensors.size(), false),
      mounts_(model.sensors.size()),
      turned_(model.sensors.size()),
      biases_(model.sensors.size()),
      exchange_(model_),
      composed_(model, options),
      is_sound_(model.sensors.size(), true),
      is_settled_(model.joints.size(), true),
      heading_sd_(model.joints.size()),
      fusion_(model),
      tool_(*model_, model.tool),
      now_(initial_state(*model_)),
      chain_state_(unknown_state(model)),
      state_(unknown_state(model)) {
  state_.alarms.reserve(4 * model.sensors.size() + 2 * model.joints.size() + 4);
}

/// After a gap the posture is unknown again; what was learnt of the sensors is kept. A position that nothing shows then
/// goes on from where it was, as uncertain as it may have moved meanwhile.
void Tracker::restart(double time) {
  if (state_.started) {
    restarted_ = time;
    go_on_from(guesses_, *tracking_, filter_, model_positions_, state_, last_time_);
    forget_state();
  }
  state_.started = false;
  grid_.reset();
  return_.reset();
  motion_.reset();
  block_.clear();
  waiting_.clear();
  waits_since_.reset();
  forget_fit();
  mounts_.reset();
  biases_.reset();
}

/// Nothing is known until the next start; alarms stay.
void Tracker::forget_state() {
  std::vector<TrackAlarm> alarms = std::move(state_.alarms);
  state_ = unknown_state(*tracking_);
  state_.alarms = std::move(alarms);
}

void Tracker::add(const InsRow& row) {
  KINFER_EXPECT(row.sensors.size() == tracking_->sensors.size());
  if (has_rows_ && row.time - last_time_ > restart_gap) restart(row.time);
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
  mounts_.correct([&](ChainFilter& filter) { rest_.correct(filter); });
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
    const bool is_used = !does_not_fit_[s] && health_[s].measures();
    if (is_used == (filter_.uses_sensor(s) || return_.waits_for(s))) continue;
    if (is_used) {
      take_in(s);
      continue;
    }
    return_.drop(s, filter_);
    use_sensor(s, false);
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
    use_sensor(sensor, true);
}

void Tracker::use_sensor(std::size_t sensor, bool is_used) {
  filter_.use_sensor(sensor, is_used);
  if (!grid_) return;
  for (StartGrid::Candidate& candidate : grid_->candidates()) candidate.filter.use_sensor(sensor, is_used);
}

/// A position that is not found, although its sensors measure, counts from where it seems to be, as at a start.
void Tracker::find_returned(const BlockMeasurement& block) {
  if (!return_.is_waiting()) return;
  const std::optional<FoundAgain> found = return_.add(block);
  if (!found) return;
  filter_ = found->filter;
  for (const FoundPosition& at : found->positions) {
    if (at.sd < turned_in_gap) continue;
    positions_.lose(at.position, at.sd, filter_.state().base);
    filter_.count_from_here(at.position);
  }
  return_.begin_again(filter_);
  begin_grid();
  replay_.begin(filter_);
}

/// How well sensors and joints have fitted until now.
void Tracker::forget_fit() {
  fit_.reset();
  turns_.reset();
}

/// Other places did not fit, which says nothing of the sensors, but of those that fitted in none.
void Tracker::forget_places() {
  fit_.reset_trusted(filter_);
  turns_.reset();
}

void Tracker::replay(const std::function<void(ChainFilter&)>& prepare) {
  forget_fit();
  mounts_.reset();  // they have believed what turned out to be wrong
  replay_.run(filter_, prepare, [&](const ChainFilter& filter, const BlockMeasurement& past) {
    fit_.add(filter, past.time, past.length);
  });
  if (return_.is_waiting()) return_.begin_again(filter_);
}

/// A base that begins to move looks like a fault of sensors or of a joint on it at first.
bool Tracker::base_begins_to_move(const BlockMeasurement& block, const Suspect& suspect) {
  if (filter_.state().base == BaseMode::moving) return false;
  base_.add(block, filter_);
  if (suspect != Suspect{}) base_.suspect(filter_);
  return base_.mode() == BaseMode::moving;
}

/// Where positions count from the start the tool is as uncertain as what they count from.
void Tracker::spread_tool() {
  for (std::size_t b = 1; b < unknown_.size(); ++b) {
    const bool is_in_grid = grid_ && grid_->body() == b && !grid_->is_of_limb();
    unknown_[b] = is_in_grid ? 0.0 : positions_.start_sd(*model_, b);
  }
  tool_.spread(*model_, filter_.state(), filter_.covariance(), unknown_);
  if (grid_)
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

void Tracker::leave_out(std::size_t sensor, double log_odds_of_turn) {
  does_not_fit_[sensor] = true;
  is_late_[sensor] = clocks_.is_late(sensor, lateness_share);
  const Agreement named = as_named(fit_.sensor(sensor), filter_.state().time);
  MountWatch mounts(does_not_fit_.size());  // of the others the filters have believed this sensor
  mounts.begin(sensor, replay_.beginning(filter_), replay_.blocks(), log_odds_of_turn);
  replay([&](ChainFilter& filter) { filter.use_sensor(sensor, false); });
  mounts_ = mounts;
  fit_.set_sensor(sensor, named);
}

void Tracker::doubt(std::size_t joint) {
  const Agreement named = as_named(fit_.joint(joint), filter_.state().time);
  replay([&](ChainFilter& filter) { filter.doubt_joint(joint, true); });
  fit_.set_joint(joint, named);
}

void Tracker::name(const LikelyCause& cause) {
  const auto& [sensor, joint] = cause.suspect;
  if (cause.suspect != Suspect{} && correct_initial_turn() != TurnAtStart::none) return;
  if (sensor >= 0) leave_out(static_cast<std::size_t>(sensor), cause.log_odds);
  if (joint >= 0) doubt(static_cast<std::size_t>(joint));
}

/// A change that showed at once, and what has followed since, once it has shown whether it lasts.
void Tracker::examine_sudden_change(double time) {
  const std::optional<double> noticed = turns_.noticed(time);
  if (!noticed) return;
  const LikelyCause cause =
      likeliest_cause(replay_.beginning(filter_), replay_.blocks(),
                      {.from = *noticed - 2.0 * turn_mean, .until = *noticed, .may_have_turned = [this](std::size_t s) {
                         return turns_.may_have_turned(s);
                       }});
  turns_.settle(time);
  if (cause.log_odds > sudden_log_odds) name(cause);
}

/// A sensor beside a joint that does not fit, where it is likelier that it turned.
Suspect Tracker::unless_turned_beside(Suspect suspect) const {
  if (suspect.joint < 0) return suspect;
  const auto turned =
      turned_beside(replay_.beginning(filter_), replay_.blocks(), static_cast<std::size_t>(suspect.joint));
  return turned ? Suspect{.sensor = static_cast<int>(*turned)} : suspect;
}

/// What does not fit wherever a joint that slides stands needs no place to be named. The places are sought anew from
/// the filter that does not believe it. A base that begins to move looks like that at first.
void Tracker::examine_places(const BlockMeasurement& block) {
  const bool slides = grid_->motion() == JointMotion::prismatic;
  if (slides) {
    replay_.add(block, filter_);
    place_fits_.add(*grid_, block.time, block.length);
  }
  const Suspect common = slides ? place_fits_.common(*grid_) : Suspect{};
  if (base_begins_to_move(block, common)) return let_base_move_in_grid();
  if (common == Suspect{}) return;
  seek_place_of_disagreement();
  if (grid_->motion() != JointMotion::prismatic) return forget_places();
  grid_.reset();
  name({.suspect = unless_turned_beside(common)});
}

/// Where sensors disagree, a joint that stands where it does by chance is likelier than a sensor that moved. On a base
/// that may move they need not show yet that it does.
void Tracker::seek_place_of_disagreement() {
  if (filter_.state().time < suspicion_from_) return;
  begin_grid(filter_.state().base == BaseMode::moving ? 0.0 : motion_suspicion);
}

/// What disagrees most is left out, as if it had never been believed, and what agrees again is taken in.
void Tracker::examine_fit() {
  const Suspect worst = fit_.worst(filter_);
  if (worst != Suspect{}) seek_place_of_disagreement();
  if (grid_) return forget_places();  // a position that motion begins to show is where it was supposed to be by chance
  name({.suspect = unless_turned_beside(worst)});
  // Of a sensor that is lost or waits nothing is compared, which looks like agreement.
  const Suspect back =
      fit_.recovered(filter_, [this](std::size_t s) { return does_not_fit_[s] && mounts_.may_return(s); });
  if (back.sensor >= 0) {
    does_not_fit_[static_cast<std::size_t>(back.sensor)] = is_late_[static_cast<std::size_t>(back.sensor)] = false;
    fit_.reset_sensor(static_cast<std::size_t>(back.sensor));
  }
  if (back.joint >= 0) {
    filter_.doubt_joint(static_cast<std::size_t>(back.joint), false);
    fit_.reset_joint(static_cast<std::size_t>(back.joint));
  }
}

/// Whether a sensor or joint is named already.
bool Tracker::is_fault_named() const {
  return filter_.doubts_any_joint() || std::ranges::find(does_not_fit_, true) != does_not_fit_.end();
}

/// A sensor that was turned before the first row. While it is open which one it was, no other fault is named.
Tracker::TurnAtStart Tracker::correct_initial_turn() {
  if (is_fault_named() || return_.is_waiting()) return TurnAtStart::none;
  const std::optional<InitialTurn> turn = initial_turn(filter_);
  if (!turn) return TurnAtStart::none;
  if (!turn->tells_sensor())
    return filter_.constant_faults().observed() < undecided_turn_patience ? TurnAtStart::open : TurnAtStart::none;
  filter_.believe_turn(turn->sensor, turn->turn.mean, turn->turn.covariance, turn->excess);
  turned_[turn->sensor] = {filter_.placed_at(), turn->log_odds / initial_turn_log_odds};
  forget_fit();
  biases_.reset();
  replay_.begin(filter_);
  return TurnAtStart::corrected;
}

void Tracker::examine_initial_turns() {
  const ConstantFaults& faults = filter_.constant_faults();
  if (faults.ends_stretch() && faults.observed() > initial_turn_after) correct_initial_turn();
}

/// The heading of a spherical joint counts as shown while its parent moves.
void Tracker::show_headings() {
  for (std::size_t b = 1; b < model_->bodies.size(); ++b)
    if (motion_shows_heading(*model_, b) && filter_.considers_heading(b) && motion_.tells_of(*model_, b))
      filter_.show_heading(b);
}

void Tracker::process_block(const BlockMeasurement& block) {
  motion_.add(block, filter_);
  if (!grid_) show_headings();
  begin_grid();
  filter_.estimate_points(shows_points());
  if (grid_) {
    mounts_.reset();
    resolve_start(block);
  } else {
    filter_.predict(block.time);
    filter_.update(block);
  }
  fit_.add(filter_, block.time, block.length);
  clocks_.add(filter_, block.length);
  turns_.add(filter_, block.time, block.length);
  for (std::size_t s = 0; s < does_not_fit_.size(); ++s)
    if (does_not_fit_[s] && clocks_.is_late(s, lateness_share_later) && !mounts_.is_turned(s)) is_late_[s] = true;
  if (grid_) {
    examine_places(block);
  } else {
    replay_.add(block, filter_);
    if (base_begins_to_move(block, fit_.worst(filter_)))
      let_base_move();
    else
      examine_fit();
    examine_sudden_change(block.time);
    mounts_.add(block, filter_, [&](std::size_t s) { return does_not_fit_[s] && health_[s].measures(); });
    biases_.add(filter_, is_fault_named(), block.time);
    if (biases_.names_any() && correct_initial_turn() == TurnAtStart::open) biases_.withhold();
    watch_misfit(block.time);
    find_returned(block);
    examine_initial_turns();
  }
  exchange_.suspect(misfit_since_ || biases_.names_any() || is_fault_named());
  exchange_.add(block, guesses_, filter_.state().base);
  spread_tool();
}

}  // namespace kinfer::track
