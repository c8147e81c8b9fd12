// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/copies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace kinfer {
namespace {

/// Numbers in which copies are equal. What is not a number is replaced, since it equals nothing.
using Key = std::vector<double>;

void append(Key& key, double number) {
  key.push_back(std::isnan(number) ? std::numeric_limits<double>::infinity() : number);
}
template <class Numbers>
void append_all(Key& key, const Numbers& numbers) {
  for (Eigen::Index i = 0; i < numbers.size(); ++i) append(key, numbers(i));
}
template <class T>
void append_entry(Key& key, const std::vector<T>& of_rows, int row) {
  if (!of_rows.empty()) append(key, static_cast<double>(of_rows[row]));
}

Key key_of_row(const PoseSet& set, int row) {
  Key key;
  append_all(key, set.joints.col(row));
  if (set.torques.size() > 0) append_all(key, set.torques.col(row));
  append_entry(key, set.payload, row), append_entry(key, set.temperature, row);
  append_entry(key, set.setup, row), append_entry(key, set.tip, row), append_entry(key, set.mounting, row);
  return key;
}

void append_values(Key& key, const PoseSet&, const PointMeasurement& m) {
  append(key, m.target), append_all(key, m.position);
}
void append_values(Key& key, const PoseSet&, const OrientationMeasurement& m) {
  append_all(key, m.orientation.coeffs());
}
void append_values(Key&, const PoseSet&, const SocketContact&) {}
void append_values(Key&, const PoseSet&, const PlaneContact&) {}
void append_values(Key& key, const PoseSet&, const DistanceMeasurement& m) {
  append(key, m.distance);
}
void append_values(Key& key, const PoseSet& set, const PairDistance& m) {
  append(key, m.distance), append_all(key, set.joints.col(m.other));
}
void append_values(Key& key, const PoseSet&, const TiltMeasurement& m) {
  append_all(key, m.specific_force);
}
void append_values(Key& key, const PoseSet&, const DirectionMeasurement& m) {
  append_all(key, m.direction);
}

template <class M>
Key key_of_measurement(const PoseSet& set, const M& measurement) {
  Key key{static_cast<double>(index(kind_of<M>))};
  if constexpr (RefersToFixture<M>) append(key, measurement.*M::fixture_index);
  append_values(key, set, measurement);
  return key;
}

bool is_held_out(const PoseSet& set, int row) {
  return !set.set.empty() && set.set[row] == SplitLabel::holdout;
}

template <class M>
void erase_copies(const PoseSet& set, std::vector<M>& list) {
  std::vector<std::size_t> order(list.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return !is_held_out(set, list[i].row); });
  std::set<Key> known;
  std::vector<bool> kept(list.size());
  for (const std::size_t i : order) {
    Key key = key_of_row(set, list[i].row);
    const Key values = key_of_measurement(set, list[i]);
    key.insert(key.end(), values.begin(), values.end());
    kept[i] = known.insert(std::move(key)).second;
  }
  std::size_t next = 0;
  std::erase_if(list, [&](const M&) { return !kept[next++]; });
}

}  // namespace

PoseSet without_copies(PoseSet set) {
  PoseMeasurements left = set;
  for_each_list(left, [&](auto& list) { erase_copies(set, list); });
  static_cast<PoseMeasurements&>(set) = std::move(left);
  return set;
}

std::vector<std::vector<int>> groups_of_copies(const PoseSet& set) {
  std::vector<std::set<Key>> measured(static_cast<std::size_t>(set.rows()));
  for_each_list(set, [&](const auto& list) {
    for (const auto& m : list) measured[m.row].insert(key_of_measurement(set, m));
  });
  std::map<std::pair<Key, std::set<Key>>, std::vector<int>> rows;
  for (int row = 0; row < set.rows(); ++row)
    if (!measured[row].empty()) rows[{key_of_row(set, row), measured[row]}].push_back(row);
  std::vector<std::vector<int>> groups;
  for (const auto& entry : rows)
    if (entry.second.size() > 1) groups.push_back(entry.second);
  std::ranges::sort(groups);
  return groups;
}

}  // namespace kinfer
