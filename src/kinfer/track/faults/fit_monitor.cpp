// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/fit_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/model/thresholds.hpp"

namespace kinfer::track {
namespace {

/// Exponential mean that forgets over `time`.
void forget(double& mean, double x, double length, double time) {
  mean += (x - mean) * (1.0 - std::exp(-length / time));
}

/// T over its expectation, limited so that one shock is no fault; of what is named already so that it fits again soon.
void average(Agreement& agreement, double x, double unlimited, bool is_named, double time, double length) {
  agreement.compared = time;
  agreement.observed += length;
  const double limit = is_named ? quick_limit : max_single;
  forget(agreement.quick, std::min(x, limit), length, short_mean);
  forget(agreement.slow, std::min(x, limit), length, long_mean);
  forget(agreement.explains, unlimited, length, short_mean);
}

/// What was shown before a silence says less and less, unless it is named.
void fade(Agreement& agreement, double time, bool is_named, double length) {
  if (is_named || time - agreement.compared < lost_after) return;
  forget(agreement.quick, 1.0, length, short_mean);
  forget(agreement.slow, 1.0, length, long_mean);
  forget(agreement.explains, 1.0, length, short_mean);
}

/// The larger mean over its threshold.
double strength(const Agreement& agreement, double quick_of_others, double slow_of_others, double tails) {
  return std::max(agreement.quick / (quick_limit * tails * quick_of_others),
                  agreement.slow / (slow_limit * tails * slow_of_others));
}

/// Of a joint, whose change its own acceleration may hide for the most part: its short mean over what it has shown in
/// the last minute. A first moment does not tell a joint from a sensor beside it.
double strength_over_usual(Agreement& joint, double quick_of_others, double time) {
  const std::optional<double> usual = joint.usual.value();
  if (!usual) return 0.0;
  const double strength = joint.quick / (quick_of_others * std::max(least_joint_change, joint_stands_out * *usual));
  if (strength < lasting_strength) joint.unusual_since.reset();
  if (strength > 1.0 && !joint.unusual_since) joint.unusual_since = time;
  return joint.unusual_since && time - *joint.unusual_since >= short_mean ? strength : 0.0;
}

void judge(Agreement& agreement, double strength, double time) {
  agreement.strength = strength;
  const bool was = agreement.is_suspect;
  agreement.is_suspect =
      agreement.observed >= settling && (was ? agreement.quick > recovered_limit : agreement.strength > 1.0);
  if (agreement.is_suspect && !was) agreement.since = time;
}

Agreement taken_in_again(const Agreement& agreement) {
  return {.observed = agreement.was_named ? settling : 0.0, .was_named = agreement.was_named};
}

bool has_recovered(const Agreement& agreement) {
  return agreement.slow < recovered_limit && agreement.quick < recovered_limit;
}

/// Index of what explains most, for which `is_candidate`; −1: none.
template <class IsCandidate>
int likeliest(const std::vector<Agreement>& agreements, const IsCandidate& is_candidate) {
  int best = -1;
  for (std::size_t i = 0; i < agreements.size(); ++i)
    if (is_candidate(i) && (best < 0 || agreements[i].explains > agreements[static_cast<std::size_t>(best)].explains))
      best = static_cast<int>(i);
  return best;
}

}  // namespace

Agreement as_named(Agreement agreement, double time) {
  if (!agreement.is_suspect) agreement.since = time;
  agreement.is_suspect = true;
  agreement.slow = quick_limit;
  agreement.was_named = true;
  return agreement;
}

void FitMonitor::reset_sensor(std::size_t index) {
  sensors_[index] = taken_in_again(sensors_[index]);
}

void FitMonitor::reset_joint(std::size_t index) {
  joints_[index] = taken_in_again(joints_[index]);
}

void FitMonitor::reset() {
  for (Agreement& sensor : sensors_) sensor = {.was_named = sensor.was_named};
  for (Agreement& joint : joints_) joint = {.was_named = joint.was_named};
}

void FitMonitor::reset_trusted(const ChainFilter& filter) {
  for (std::size_t s = 0; s < sensors_.size(); ++s)
    if (filter.uses_sensor(s)) sensors_[s] = {.was_named = sensors_[s].was_named};
  for (std::size_t j = 0; j < joints_.size(); ++j)
    if (!filter.doubts_joint(j)) joints_[j] = {.was_named = joints_[j].was_named};
}

void FitMonitor::add(const ChainFilter& filter, double time, double length) {
  const Innovations& innovations = filter.innovations();
  for (std::size_t s = 0; s < sensors_.size(); ++s)
    if (const int rows = innovations.rows[s]; rows > 0)
      average(sensors_[s], innovations.leave_out[s] / rows, innovations.unlimited[s] / rows, !filter.uses_sensor(s),
              time, length);
    else
      fade(sensors_[s], time, !filter.uses_sensor(s), length);
  for (std::size_t j = 0; j < joints_.size(); ++j)
    if (innovations.of_joint[j] > 0.0)
      average(joints_[j], innovations.of_joint[j] / change_rows, innovations.unlimited_of_joint[j] / change_rows,
              filter.doubts_joint(j), time, length);
    else
      fade(joints_[j], time, filter.doubts_joint(j), length);
  // Where all are trusted less already, the tails of the innovations are heavier than those of the hand-over.
  const double tails = std::sqrt(filter.levels().common());
  for (std::size_t s = 0; s < sensors_.size(); ++s)
    if (innovations.rows[s] > 0)
      judge(sensors_[s],
            strength(sensors_[s], median_of_others(filter, s, &Agreement::quick),
                     median_of_others(filter, s, &Agreement::slow), tails),
            time);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    if (innovations.of_joint[j] <= 0.0) continue;
    const double others = median_of_other_joints(filter, j, &Agreement::quick);
    judge(joints_[j],
          std::max(strength(joints_[j], others, median_of_other_joints(filter, j, &Agreement::slow), tails),
                   strength_over_usual(joints_[j], others, time)),
          time);
    if (joints_[j].observed >= settling) joints_[j].usual.add(joints_[j].quick, time);
  }
}

namespace {

/// At least 1: where most disagree it is the motion that the chain does not explain, and none is at fault.
double median_from_one(std::vector<double>& values, std::size_t count) {
  if (count == 0) return 1.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((count - 1) / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
  return std::max(1.0, *middle);
}

}  // namespace

double FitMonitor::median_of_others(const ChainFilter& filter, std::size_t sensor, double Agreement::*mean) const {
  std::size_t count = 0;
  for (std::size_t s = 0; s < sensors_.size(); ++s)
    if (s != sensor && filter.uses_sensor(s)) ordered_[count++] = sensors_[s].*mean;
  return median_from_one(ordered_, count);
}

double FitMonitor::median_of_other_joints(const ChainFilter& filter, std::size_t joint, double Agreement::*mean) const {
  std::size_t count = 0;
  for (std::size_t j = 0; j < joints_.size(); ++j)
    if (j != joint && filter.innovations().of_joint[j] > 0.0 && !filter.doubts_joint(j))
      ordered_[count++] = joints_[j].*mean;
  return median_from_one(ordered_, count);
}

/// A change of a joint and one of a sensor have as many unknowns: the one that explains most is the likeliest.
Suspect FitMonitor::likeliest_of(const std::function<bool(const Agreement&)>& is_candidate,
                                 const ChainFilter& filter) const {
  const int sensor =
      likeliest(sensors_, [&](std::size_t s) { return filter.uses_sensor(s) && is_candidate(sensors_[s]); });
  const int joint =
      likeliest(joints_, [&](std::size_t j) { return !filter.doubts_joint(j) && is_candidate(joints_[j]); });
  if (joint < 0) return {.sensor = sensor};
  if (sensor < 0) return {.joint = joint};
  const bool is_joint =
      joints_[static_cast<std::size_t>(joint)].explains > sensors_[static_cast<std::size_t>(sensor)].explains;
  return is_joint ? Suspect{.joint = joint} : Suspect{.sensor = sensor};
}

/// Where anything is suspect: one that was named before and is suspect again, or the likeliest of all, unless that was
/// compared for too short a time.
Suspect FitMonitor::worst(const ChainFilter& filter) const {
  const auto is_suspect = [](const Agreement& a) { return a.is_suspect; };
  if (likeliest_of(is_suspect, filter) == Suspect{}) return {};
  const Suspect again = likeliest_of([](const Agreement& a) { return a.is_suspect && a.was_named; }, filter);
  if (again != Suspect{}) return again;
  const Suspect named = likeliest_of([](const Agreement&) { return true; }, filter);
  const Agreement& agreement = named.joint >= 0 ? joints_[static_cast<std::size_t>(named.joint)]
                                                : sensors_[static_cast<std::size_t>(named.sensor)];
  return agreement.observed < settling ? Suspect{} : named;
}

Suspect FitMonitor::recovered(const ChainFilter& filter, const std::function<bool(std::size_t)>& may_return) const {
  Suspect back;
  for (std::size_t s = 0; s < sensors_.size() && back.sensor < 0; ++s)
    if (!filter.uses_sensor(s) && has_recovered(sensors_[s]) && may_return(s)) back.sensor = static_cast<int>(s);
  for (std::size_t j = 0; j < joints_.size() && back.joint < 0; ++j)
    if (filter.doubts_joint(j) && has_recovered(joints_[j])) back.joint = static_cast<int>(j);
  return back;
}

}  // namespace kinfer::track
