// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/smooth/smoother.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "kinfer/track/readout/readout.hpp"
#include "kinfer/track/smooth/pass_state.hpp"
#include "kinfer/track/smooth/reversed.hpp"
#include "kinfer/track/smooth/shared_covariance.hpp"
#include "kinfer/track/tracker.hpp"

namespace kinfer::track {
namespace {

using Array = Eigen::ArrayXd;

constexpr double shared_period = 0.2;  // [s] the shared part costs a Cholesky factorisation and changes slowly

/// Shared parts over standard deviations.
struct SharedRatios {
  Array q;
  Eigen::Array3d base = Eigen::Array3d::Zero(), tool_position = base, tool_rotation = base;
};

/// A tracker with the part of its standard deviations that it shares with another one on the same recording.
class Pass {
 public:
  Pass(const TrackingModel& model, const TrackOptions& options)
      : model_(model),
        tracker_(model, options),
        covariance_(tracker_.filter().model()),
        spread_(tracker_.filter().model(), model.tool),
        shared_(unknown_state(model)) {
    ratios_.q = Array::Zero(model.positions());
  }

  void add(const InsRow& row) { tracker_.add(row); }

  const Tracker& tracker() const { return tracker_; }

  PassState state() {
    const TrackState& now = tracker_.state();
    if (now.started && !(std::abs(now.time - updated_) < shared_period)) update_ratios();
    return {.started = now.started,
            .q = now.q,
            .qd = now.qd,
            .sd_q = now.sd_q,
            .sd_qd = now.sd_qd,
            .shared_q = ratios_.q * now.sd_q.array(),
            .joints = now.joints,
            .world_q_base = now.world_q_base,
            .sd_base = now.sd_base,
            .shared_base = ratios_.base * now.sd_base.array(),
            .sd_tool_position = now.sd_tool_position,
            .shared_tool_position = ratios_.tool_position * now.sd_tool_position.array(),
            .sd_tool_rotation = now.sd_tool_rotation,
            .shared_tool_rotation = ratios_.tool_rotation * now.sd_tool_rotation.array()};
  }

 private:
  void update_ratios() {
    const TrackState& now = tracker_.state();
    const ChainFilter& filter = tracker_.filter();
    updated_ = now.time;
    covariance_.update(filter);
    track::read_out(model_, filter.model(), filter.state(), covariance_.value(), shared_);
    spread_.spread(filter.model(), filter.state(), covariance_.value());
    const auto over = [](const auto& part, const auto& whole) {
      return (part.array() / whole.array().max(1e-12)).min(1.0).eval();
    };
    ratios_ = {.q = over(shared_.sd_q, now.sd_q),
               .base = over(shared_.sd_base, now.sd_base),
               .tool_position = over(spread_.position_sd(), now.sd_tool_position),
               .tool_rotation = over(spread_.rotation_sd(), now.sd_tool_rotation)};
  }

  const TrackingModel& model_;
  Tracker tracker_;
  SharedCovariance covariance_;
  ToolSpread spread_;
  TrackState shared_;
  SharedRatios ratios_;
  double updated_ = std::numeric_limits<double>::quiet_NaN();
};

/// Both passes may have found limbs turned otherwise: the tool is that of the forward pass.
void keep_tool(const TrackState& forward, TrackState& to) {
  to.base_T_tool = forward.base_T_tool;
  to.sd_tool_position = forward.sd_tool_position;
  to.sd_tool_rotation = forward.sd_tool_rotation;
}

void notify_pass(const Observer& observer, std::string_view stage, std::size_t done, std::size_t all) {
  constexpr std::size_t every = 500;
  if (done % every == 0)
    notify(observer, {.stage = stage, .fraction = static_cast<double>(done) / static_cast<double>(all), .detail = {}});
}

/// The state at each row, of a machine that moves forward.
std::vector<PassState> backward_pass(const TrackingModel& model, BaseMotion base, std::span<const InsRow> rows,
                                     const Observer& observer) {
  const TrackingModel turned = reversed(model);
  Pass pass(turned, {.base = base});
  std::vector<PassState> states(rows.size());
  for (std::size_t i = rows.size(); i-- > 0;) {
    notify_pass(observer, "backward pass", rows.size() - i, rows.size());
    pass.add(reversed(rows[i], rows.back().time));
    states[i] = pass.state();
    states[i].qd = -states[i].qd;
  }
  return states;
}

}  // namespace

void smooth(const TrackingModel& model, const TrackOptions& options, std::span<const InsRow> rows,
            const std::function<void(const TrackState&)>& add, const Observer& observer) {
  if (rows.empty()) return;
  const std::vector<PassState> backward = backward_pass(model, options.base, rows, observer);
  Pass forward(model, options);
  const bool has_unknown_turns = !forward.tracker().filter().model().unknown_turns.empty();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    notify_pass(observer, "forward pass", i + 1, rows.size());
    forward.add(rows[i]);
    TrackState state = forward.tracker().state();
    combine(model, forward.state(), backward[i], state);
    if (has_unknown_turns && forward.tracker().state().started) keep_tool(forward.tracker().state(), state);
    add(state);
  }
}

}  // namespace kinfer::track
