// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinfer::track {
namespace {

using Index = Eigen::Index;

constexpr std::size_t most_bins = 2000;     // a screen shows no more
constexpr std::size_t most_events = 10000;  // a run with more is hopeless anyway
constexpr double shortest_break = 2.0;      // [s] between two alarms of the same kind that count as two
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Of two values, of which any may be unknown.
double least(double a, double b) {
  return std::isnan(a) || b < a ? b : a;
}
double greatest(double a, double b) {
  return std::isnan(a) || b > a ? b : a;
}

bool is_same_alarm(const TrackAlarm& a, const TrackAlarm& b) {
  return a.kind == b.kind && a.sensor == b.sensor && a.joint == b.joint;
}

bool rotates(const TrackingModel& model, std::size_t position) {
  for (const TrackingJoint& joint : model.joints)
    if (joint.first_position == static_cast<int>(position)) return joint.type != EstimatedJointType::prismatic;
  return true;
}

}  // namespace

RunRecorder::RunRecorder(const TrackingModel& model) : model_(model) {
  for (const TrackingJoint& joint : model.joints) shares_.push_back({.name = joint.name});
}

void RunRecorder::add(const TrackState& state) {
  if (bins_.empty() || bins_.back().rows == rows_per_bin_) start_bin(state);
  Bin& bin = bins_.back();
  ++rows_;
  ++bin.rows;
  bin.end = state.time;
  for (Index k = 0; k < state.q.size(); ++k) {
    bin.low[k] = least(bin.low[k], state.q[k]);
    bin.high[k] = greatest(bin.high[k], state.q[k]);
    bin.sd[k] = greatest(bin.sd[k], state.sd_q[k]);
  }
  for (std::size_t s = 0; s < state.innovation.size(); ++s)
    bin.innovation[static_cast<Index>(s)] += state.innovation[s];
  if (state.base_T_tool.position.allFinite() && state.q.allFinite()) {
    bin.tool = state.base_T_tool.position;
    bin.tool_sd = std::max(bin.tool_sd, state.sd_tool_position.maxCoeff());
    ++bin.tool_rows;
  }
  for (std::size_t j = 0; j < state.joints.size(); ++j) {
    shares_[j].composed += state.joints[j].source == JointSource::composed ? 1.0 : 0.0;
    shares_[j].unknown += state.joints[j].source == JointSource::none ? 1.0 : 0.0;
    shares_[j].relative_to_start += state.joints[j].reference == JointReference::start ? 1.0 : 0.0;
  }
  follow_alarms(state);
}

void RunRecorder::start_bin(const TrackState& state) {
  if (bins_.size() == most_bins) merge_pairs();
  if (!bins_.empty() && bins_.back().rows < rows_per_bin_) return;
  const VectorXd unknown = VectorXd::Constant(state.q.size(), not_a_number);
  bins_.push_back({.begin = state.time,
                   .end = state.time,
                   .low = unknown,
                   .high = unknown,
                   .sd = unknown,
                   .innovation = VectorXd::Zero(static_cast<Index>(model_.sensors.size()))});
}

void RunRecorder::merge_pairs() {
  rows_per_bin_ *= 2;
  std::vector<Bin> merged;
  for (std::size_t i = 0; i + 1 < bins_.size(); i += 2) {
    Bin bin = bins_[i];
    const Bin& next = bins_[i + 1];
    bin.end = next.end;
    bin.rows += next.rows;
    bin.low = bin.low.binaryExpr(next.low, &least);
    bin.high = bin.high.binaryExpr(next.high, &greatest);
    bin.sd = bin.sd.binaryExpr(next.sd, &greatest);
    bin.innovation += next.innovation;
    if (next.tool_rows > 0) bin.tool = next.tool;
    bin.tool_rows += next.tool_rows;
    bin.tool_sd = std::max(bin.tool_sd, next.tool_sd);
    merged.push_back(std::move(bin));
  }
  bins_ = std::move(merged);
}

void RunRecorder::follow_alarms(const TrackState& state) {
  for (TrackEvent& event : events_) {
    const auto same = [&](const TrackAlarm& alarm) { return is_same_alarm(alarm, event.alarm); };
    if (std::isnan(event.until) && std::ranges::none_of(state.alarms, same)) event.until = state.time;
  }
  for (const TrackAlarm& alarm : state.alarms) {
    const auto continues = [&](const TrackEvent& event) {
      return is_same_alarm(alarm, event.alarm) &&
             (std::isnan(event.until) || state.time - event.until < shortest_break);
    };
    const auto event = std::ranges::find_if(events_, continues);
    if (event != events_.end()) {
      event->until = not_a_number;
      event->alarm.strength = std::max(event->alarm.strength, alarm.strength);
      if (alarm.turn) event->alarm.turn = alarm.turn;  // the longer it was seen the better it is known
    } else if (events_.size() < most_events) {
      events_.push_back({.alarm = alarm, .until = not_a_number});
    }
  }
}

TrackRun RunRecorder::run() const {
  TrackRun run{.rows = rows_, .joints = shares_, .events = events_};
  if (bins_.empty()) return run;
  run.begin = bins_.front().begin;
  run.end = bins_.back().end;
  for (TrackJointShare& joint : run.joints)
    for (double* share : {&joint.composed, &joint.unknown, &joint.relative_to_start})
      *share /= static_cast<double>(rows_);
  const std::vector<std::string> names = position_names(model_);
  for (std::size_t k = 0; k < names.size(); ++k)
    run.positions.push_back({.name = names[k], .rotates = rotates(model_, k)});
  for (const TrackingSensor& sensor : model_.sensors) run.sensors.push_back({.name = sensor.name});
  for (const Bin& bin : bins_) {
    run.time.push_back(0.5 * (bin.begin + bin.end));
    for (std::size_t k = 0; k < names.size(); ++k) {
      run.positions[k].low.push_back(bin.low[static_cast<Index>(k)]);
      run.positions[k].high.push_back(bin.high[static_cast<Index>(k)]);
      run.positions[k].sd.push_back(bin.sd[static_cast<Index>(k)]);
    }
    for (std::size_t s = 0; s < run.sensors.size(); ++s)
      run.sensors[s].innovation.push_back(bin.innovation[static_cast<Index>(s)] / bin.rows);
    run.tool.push_back(bin.tool_rows > 0 ? bin.tool : Vec3::Constant(not_a_number));
    run.tool_sd.push_back(bin.tool_sd);
  }
  return run;
}

}  // namespace kinfer::track
