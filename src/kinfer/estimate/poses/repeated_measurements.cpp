// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/repeated_measurements.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "kinfer/kinematics/joint_scales.hpp"
#include "kinfer/measurement/commanded_poses.hpp"

namespace kinfer {
namespace {

using RowState = std::tuple<int, int, double, double>;  // pose, mounting, payload, temperature

template <class T>
T entry_or(const std::vector<T>& list, std::size_t row, T otherwise) {
  return list.empty() ? otherwise : list[row];
}

template <class M>
int object_of(const M& measurement) {
  if constexpr (RefersToFixture<M>) return measurement.*M::fixture_index;
  if constexpr (std::is_same_v<M, PointMeasurement>) return measurement.target;
  return -1;
}

template <class M>
RepeatedMeasurements groups_of(const std::vector<int>& states, const std::vector<M>& list) {
  RepeatedMeasurements groups;
  std::map<std::pair<int, int>, int> known;  // state, fixture or target
  for (const M& measurement : list) {
    const std::pair quantity(states[static_cast<std::size_t>(measurement.row)], object_of(measurement));
    const auto [at, is_new] = known.try_emplace(quantity, static_cast<int>(known.size()));
    groups.group.push_back(at->second);
    if (is_new) groups.size.push_back(0.0);
    groups.size[static_cast<std::size_t>(at->second)] += 1.0;
  }
  return known.size() == list.size() ? RepeatedMeasurements{} : groups;
}

bool repeats_a_pose(const std::vector<int>& pose) {
  std::vector<int> sorted = pose;
  std::ranges::sort(sorted);
  return std::ranges::adjacent_find(sorted) != sorted.end();
}

}  // namespace

PoseSet with_commanded_poses(PoseSet data, const Chain& chain) {
  data.pose = commanded_poses(data.joints, joint_scales(chain, data.joints));
  return data;
}

std::vector<int> states_of_rows(const PoseSet& data, const std::vector<int>& poses) {
  std::vector<int> states;
  std::map<RowState, int> known;
  for (std::size_t row = 0; row < poses.size(); ++row) {
    const double kelvin = std::round(entry_or(data.temperature, row, 0.0));
    const RowState state{poses[row], entry_or(data.mounting, row, -1), entry_or(data.payload, row, 0.0),
                         std::isnan(kelvin) ? 0.0 : kelvin};
    states.push_back(known.try_emplace(state, static_cast<int>(known.size())).first->second);
  }
  return states;
}

std::array<RepeatedMeasurements, measurement_kinds> repeated_measurements(const PoseSet& data) {
  std::array<RepeatedMeasurements, measurement_kinds> repeated;
  if (!repeats_a_pose(data.pose)) return repeated;
  const std::vector<int> states = states_of_rows(data, data.pose);
  for_each_list(data, [&]<class M>(const std::vector<M>& list) {
    if constexpr (!std::is_same_v<M, PairDistance>) repeated[index(kind_of<M>)] = groups_of(states, list);
  });
  return repeated;
}

}  // namespace kinfer
