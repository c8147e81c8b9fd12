// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/turn_beside_joint.hpp"

#include "kinfer/base/square.hpp"
#include "kinfer/track/faults/mount_turn.hpp"
#include "kinfer/track/faults/thresholds.hpp"

namespace kinfer::track {
namespace {

/// `change` is called before each row.
template <class Change>
double log_likelihood(ChainFilter filter, std::span<const BlockMeasurement> rows, const Change& change) {
  double sum = 0.0;
  for (const BlockMeasurement& block : rows) {
    change(filter);
    filter.predict(block.time);
    filter.update(block);
    sum += filter.innovations().log_likelihood;
  }
  return sum;
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

}  // namespace

std::optional<std::size_t> turned_beside(const ChainFilter& before, std::span<const BlockMeasurement> rows,
                                         std::size_t joint) {
  ChainFilter doubting = before;
  doubting.doubt_joint(joint, true);
  double most = log_likelihood(doubting, rows, [](ChainFilter&) {});
  std::optional<std::size_t> turned;
  for (const std::size_t sensor : sensors_beside(before.model(), joint)) {
    if (!before.uses_sensor(sensor)) continue;
    const double walk = square(turned_mount_sd) / static_cast<double>(rows.size());
    const double by_turn =
        log_likelihood(before, rows, [&](ChainFilter& filter) { loosen_mount(filter, sensor, walk); });
    if (by_turn > most) most = by_turn, turned = sensor;
  }
  return turned;
}

}  // namespace kinfer::track
