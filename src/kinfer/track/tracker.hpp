// SPDX-License-Identifier: Apache-2.0
// Tracks a machine on its identified chain, row by row: joint positions and velocities, base attitude and tool pose
// with standard deviations, from gyroscopes and accelerometers.
#pragma once

#include <functional>

#include "kinfer/evidence/tracking/track_state.hpp"
#include "kinfer/evidence/tracking/tracking_model.hpp"
#include "kinfer/track/composed.hpp"
#include "kinfer/track/faults/bias_watch.hpp"
#include "kinfer/track/faults/change_hypotheses.hpp"
#include "kinfer/track/faults/clock_watch.hpp"
#include "kinfer/track/faults/exchange.hpp"
#include "kinfer/track/faults/fit_monitor.hpp"
#include "kinfer/track/faults/initial_turns.hpp"
#include "kinfer/track/faults/mount_watch.hpp"
#include "kinfer/track/faults/place_fits.hpp"
#include "kinfer/track/faults/replay.hpp"
#include "kinfer/track/faults/sensor_health.hpp"
#include "kinfer/track/faults/sensor_return.hpp"
#include "kinfer/track/faults/turn_watch.hpp"
#include "kinfer/track/joint_fusion.hpp"
#include "kinfer/track/options.hpp"
#include "kinfer/track/readout/tool_spread.hpp"
#include "kinfer/track/rest/base_watch.hpp"
#include "kinfer/track/rest/motion_watch.hpp"
#include "kinfer/track/rest/rest_bias.hpp"
#include "kinfer/track/rows/row_block.hpp"
#include "kinfer/track/start/known_positions.hpp"
#include "kinfer/track/start/position_guesses.hpp"
#include "kinfer/track/start/power_up.hpp"
#include "kinfer/track/start/settled_start.hpp"
#include "kinfer/track/start/start_by_turn.hpp"
#include "kinfer/track/start/start_grid.hpp"
#include "kinfer/track/start/start_spread.hpp"

namespace kinfer::track {

/// Copyable; no allocation in add() once it has started, unless it starts again.
class Tracker {
 public:
  explicit Tracker(const TrackingModel& model, const TrackOptions& options = {});

  /// Processes the next row.
  void add(const InsRow& row);

  /// At the time of the last row.
  const TrackState& state() const { return state_; }

  /// Of the filter on the chain alone, not averaged with the composed positions; for studies. Alarms are empty.
  const TrackState& chain_state() const { return chain_state_; }

  /// The filter on the chain itself, for studies and smoothing.
  const ChainFilter& filter() const { return filter_; }

 private:
  void restart(double time);
  void forget_state();
  void wait_for_start();
  void try_start();
  void place_axes(const BlockMeasurement& block);
  void weigh_biases(const InitialPosture& posture);
  void list_wrong_starts(const InitialPosture& posture);
  void process_block(const BlockMeasurement& block);
  void resolve_start(const BlockMeasurement& block);
  void give_up_grid(double time);
  void choose_sensors();
  void take_in(std::size_t sensor);
  void find_returned(const BlockMeasurement& block);
  void forget_fit();
  void forget_places();
  void use_sensor(std::size_t sensor, bool is_used);
  void replay(const std::function<void(ChainFilter&)>& prepare);
  bool base_begins_to_move(const BlockMeasurement& block, const Suspect& suspect);
  void free_base(ChainFilter& filter) const;
  void let_base_move();
  void let_base_move_in_grid();
  void show_headings();
  bool shows_points() const;
  std::size_t first_unknown_limb() const;
  void begin_grid(double share = 1.0);
  void widen_by_places();
  void begin_grid_along(std::size_t body);
  void spread_tool();
  void widen_unknown();
  void leave_out(std::size_t sensor, double log_odds_of_turn);
  void doubt(std::size_t joint);
  void name(const LikelyCause& cause);
  void examine_sudden_change(double time);
  void seek_place_of_disagreement();
  void examine_fit();
  Suspect unless_turned_beside(Suspect suspect) const;
  void examine_places(const BlockMeasurement& block);
  void watch_misfit(double time);
  void examine_initial_turns();
  enum class TurnAtStart { none, open, corrected };
  TurnAtStart correct_initial_turn();
  bool is_fault_named() const;
  void end_block();
  void list_alarms(double time);
  void correct_in_rest();
  void read_out(double time);
  void state_headings();

  std::shared_ptr<const TrackingModel> tracking_;
  std::shared_ptr<const FilterModel> model_;
  std::vector<ModelPosition> model_positions_;  // of each joint position of the filter
  std::vector<PositionGuess> guesses_;          // likewise
  ChainFilter filter_;
  std::optional<StartGrid> grid_;
  double suspicion_from_ = -1e9;  // [s] from when on a suspicion of motion begins a grid
  MotionWatch motion_;
  StartSpread spread_;
  std::vector<double> unknown_;  // as of ToolSpread
  KnownPositions positions_;
  RowBlock block_;
  std::vector<BlockMeasurement> waiting_;  // for the start
  RestBias rest_;
  BaseWatch base_;
  HealthWatch health_;
  FitMonitor fit_;
  PlaceFits place_fits_;  // while a grid is open
  ClockWatch clocks_;
  TurnWatch turns_;
  Replay replay_;
  SensorReturn return_;
  std::vector<bool> does_not_fit_;  // sensors out of use because they disagree
  std::vector<bool> is_late_;       // of these, by their clocks
  MountWatch mounts_;               // of these
  /// A sensor that was turned since the first row.
  struct Turned {
    double since = 0.0, strength = 0.0;  // [s]
  };
  std::vector<std::optional<Turned>> turned_;
  BiasWatch biases_;
  ExchangeWatch exchange_;
  std::optional<double> waits_since_;  // [s] for a start in a quieter moment
  ComposedFilters composed_;
  std::vector<bool> is_sound_, is_settled_;  // sensors that the composed filters may use; joints that are not open
  std::vector<std::optional<double>> heading_sd_;  // as of JointFusion
  JointFusion fusion_;
  ToolSpread tool_;
  ChainState now_;  // predicted to the last row
  std::optional<double> restarted_{}, misfit_since_{};
  std::vector<TrackAlarm> wrong_starts_;
  double last_time_ = 0.0;
  bool has_rows_ = false;
  TrackState chain_state_, state_;
};

}  // namespace kinfer::track
