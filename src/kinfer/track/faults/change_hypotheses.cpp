// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/change_hypotheses.hpp"

#include <algorithm>

#include "kinfer/base/square.hpp"
#include "kinfer/track/faults/mount_turn.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

using Rows = std::span<const BlockMeasurement>;

/// ln of the likelihood.
double log_likelihood(ChainFilter filter, Rows rows) {
  return filter.run(rows);
}

ChainFilter doubting(ChainFilter filter, std::size_t joint) {
  filter.doubt_joint(joint, true);
  return filter;
}

double log_likelihood_if_doubted(const ChainFilter& filter, Rows rows, std::size_t joint) {
  return log_likelihood(doubting(filter, joint), rows);
}

/// By how much the last rows are likelier if the joint is doubted, ln, which it was before them already: a knock is
/// over then, a worn pin is not.
double lasting_log_odds(ChainFilter filter, Rows rows, std::size_t joint) {
  ChainFilter doubts = doubting(filter, joint);
  const std::size_t first = rows.size() - std::min(rows.size(), lasting_blocks);
  filter.run(rows.first(first));
  doubts.run(rows.first(first));
  return doubts.run(rows.subspan(first)) - filter.run(rows.subspan(first));
}

/// The mounting turned at some time within them: its turn is a random walk.
double log_likelihood_if_turning(ChainFilter filter, Rows rows, std::size_t sensor) {
  const double walk = square(turned_mount_sd) / static_cast<double>(rows.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    loosen_mount(filter, sensor, walk);
    sum += filter.run(rows.subspan(i, 1));
  }
  return sum;
}

/// It turned before the first of them.
double log_likelihood_if_turned(ChainFilter filter, Rows rows, std::size_t sensor) {
  loosen_mount(filter, sensor, square(turned_mount_sd));
  return filter.run(rows);
}

/// Those on both sides of it.
std::vector<std::size_t> sensors_beside(const FilterModel& model, std::size_t joint) {
  std::vector<std::size_t> sensors;
  const std::size_t child = model.joints[joint].bodies.front();
  auto parent = static_cast<std::size_t>(model.bodies[child].parent);
  while (parent > 0 && model.bodies[parent].sensor < 0) parent = static_cast<std::size_t>(model.bodies[parent].parent);
  for (const std::size_t b : {parent, child})
    if (model.bodies[b].sensor >= 0) sensors.push_back(static_cast<std::size_t>(model.bodies[b].sensor));
  return sensors;
}

/// Rows until a time.
std::size_t rows_until(Rows rows, double time) {
  return static_cast<std::size_t>(std::ranges::upper_bound(rows, time, {}, &BlockMeasurement::time) - rows.begin());
}

/// At some time within the first `turning` rows; `none`: log-likelihood if nothing happened.
template <class MayHaveTurned>
LikelyCause likeliest_turn(ChainFilter filter, Rows rows, std::size_t turning, double none,
                           const MayHaveTurned& may_have_turned) {
  LikelyCause cause;
  double sound = 0.0;  // likelihood of the rows before the turn
  while (turning > 0) {
    for (std::size_t s = 0; s < filter.model().sensors.size(); ++s) {
      if (!may_have_turned(s)) continue;
      const double log_odds = sound + log_likelihood_if_turned(filter, rows, s) - none;
      if (log_odds > cause.log_odds) cause = {{.sensor = static_cast<int>(s)}, log_odds};
    }
    const std::size_t step = std::min(turning, turn_step);
    sound += filter.run(rows.first(step));
    rows = rows.subspan(step);
    turning -= step;
  }
  return cause;
}

/// Of those beside a sensor that may have turned.
template <class MayHaveTurned>
LikelyCause likeliest_joint(const ChainFilter& filter, Rows rows, double none, const MayHaveTurned& may_have_turned) {
  LikelyCause cause;
  for (std::size_t j = 0; j < filter.model().joints.size(); ++j) {
    if (std::ranges::none_of(sensors_beside(filter.model(), j), may_have_turned)) continue;
    const double log_odds = log_likelihood_if_doubted(filter, rows, j) - none;
    if (log_odds > cause.log_odds) cause = {{.joint = static_cast<int>(j)}, log_odds};
  }
  return cause;
}

}  // namespace

std::optional<std::size_t> turned_beside(const ChainFilter& before, Rows rows, std::size_t joint) {
  double most = log_likelihood_if_doubted(before, rows, joint);
  std::optional<std::size_t> turned;
  for (const std::size_t sensor : sensors_beside(before.model(), joint)) {
    if (!before.uses_sensor(sensor)) continue;
    const double by_turn = log_likelihood_if_turning(before, rows, sensor);
    if (by_turn > most) most = by_turn, turned = sensor;
  }
  return turned;
}

LikelyCause likeliest_cause(const ChainFilter& before, Rows rows, const SuddenChange& change) {
  ChainFilter filter = before;
  const std::size_t sound = rows_until(rows, change.from);
  filter.run(rows.first(sound));
  rows = rows.subspan(sound);
  const auto may_have_turned = [&](std::size_t s) { return filter.uses_sensor(s) && change.may_have_turned(s); };
  const double none = log_likelihood(filter, rows);
  const LikelyCause turn = likeliest_turn(filter, rows, rows_until(rows, change.until), none, may_have_turned);
  LikelyCause joint = likeliest_joint(filter, rows, none, may_have_turned);
  if (joint.log_odds <= turn.log_odds) return turn;
  joint.log_odds = lasting_log_odds(filter, rows, static_cast<std::size_t>(joint.suspect.joint));
  return joint;
}

}  // namespace kinfer::track
