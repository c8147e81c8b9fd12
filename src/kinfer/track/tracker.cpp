// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/filter/thresholds.hpp"
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
    posture = initial_posture(*model_, block, guesses_, base_.mode());
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

/// A base that begins to move looks like a fault of sensors at first.
bool Tracker::base_begins_to_move(const BlockMeasurement& block, const Suspect& suspect) {
  if (filter_.state().base == BaseMode::moving) return false;
  base_.add(block, filter_);
  if (suspect.sensor >= 0) base_.suspect(filter_);
  return base_.mode() == BaseMode::moving;
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

/// Of the first joint position that motion shows from now on, or `share` of certain motion. A revolute one goes before
/// one along a joint: while it stands where it does by chance, a filter that believes in it is soon beyond repair.
void Tracker::begin_grid(double share) {
  if (grid_ && model_->bodies[grid_->body()].motion == JointMotion::revolute) return;
  const auto is_told = [&](std::size_t b) { return motion_.tells_of(*model_, b, share); };
  if (const std::size_t turns = positions_.first_open(*model_, JointMotion::revolute, is_told); turns > 0)
    grid_ = StartGrid::around(filter_, turns, positions_[static_cast<std::size_t>(model_->layout.position[turns])]);
  else if (const std::size_t limb = first_unknown_limb(); limb > 0)
    grid_ = StartGrid::of_limb(filter_, limb);
  else if (const std::size_t slides = positions_.first_open(*model_, JointMotion::prismatic, is_told);
           slides > 0 && !grid_) {
    place_fits_.reset();
    grid_ = StartGrid::along(filter_, slides, guesses_[static_cast<std::size_t>(model_->layout.position[slides])]);
  }
}

/// Where positions count from the start the tool is as uncertain as what they count from.
void Tracker::spread_tool() {
  for (std::size_t b = 1; b < unknown_.size(); ++b) {
    const bool is_in_grid = grid_ && grid_->body() == b && !grid_->is_of_limb();
    unknown_[b] = is_in_grid ? 0.0 : positions_.start_sd(*model_, b);
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
