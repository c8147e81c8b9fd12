// SPDX-License-Identifier: Apache-2.0
#include "kinfer/measurement/row_selection.hpp"

#include <algorithm>
#include <numeric>
#include <set>

namespace kinfer {

std::vector<int> all_rows(const PoseSet& data) {
  std::vector<int> rows(data.rows());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

std::vector<int> without(std::vector<int> rows, const std::vector<int>& others) {
  const std::set<int> unwanted(others.begin(), others.end());
  std::erase_if(rows, [&](int row) { return unwanted.contains(row); });
  return rows;
}

std::vector<int> spread_indices(int count, int most) {
  const int kept = std::min(count, most);
  std::vector<int> indices;
  for (int k = 0; k < kept; ++k) indices.push_back(static_cast<int>(static_cast<long>(k) * count / kept));
  return indices;
}

std::vector<int> thinned_rows(const PoseSet& data, std::size_t most) {
  std::set<int> with_points;
  for (const PointMeasurement& point : data.points) with_points.insert(point.row);
  const std::vector<int> rows(with_points.begin(), with_points.end());
  const std::size_t count = std::min(most, rows.size());  // more than an int may be asked for
  std::vector<int> kept;
  for (const int i : spread_indices(static_cast<int>(rows.size()), static_cast<int>(count)))
    kept.push_back(rows[static_cast<std::size_t>(i)]);
  return kept;
}

PoseSet thin_pose_set(const PoseSet& data, std::size_t most) {
  PoseSet thin = select(data, thinned_rows(data, most));
  thin.orientations.clear();
  return thin;
}

}  // namespace kinfer
