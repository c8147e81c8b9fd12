// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/pose_means.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "kinfer/estimate/poses/repeated_measurements.hpp"
#include "kinfer/measurement/row_selection.hpp"

namespace kinfer::calibrate {
namespace {

using RepeatedKinds = std::array<RepeatedMeasurements, measurement_kinds>;

/// The first point of each group where the mean of their residuals would have it, as accurate as the mean.
void average_points(PoseSet& data, const RepeatedMeasurements& groups, const Chain& chain, const Weights& stated,
                    double excess, int threads) {
  const EvaluatedPoses at = evaluate_poses(chain, {}, data, Derivative::no, threads);
  std::vector<Vec3> residual, mean(groups.size.size(), Vec3::Zero());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const PointMeasurement& point = data.points[i];
    const Pose& tool = at.pose[static_cast<std::size_t>(point.row)];
    const Vec3 target = point.target < 0 ? Vec3::Zero().eval() : Vec3(chain.targets[point.target].xyz);
    residual.push_back(point.position - tool.position - tool.rotation * target);
    mean[static_cast<std::size_t>(groups.group[i])] += residual.back() / groups.size_of(i);
  }
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    PointMeasurement& point = data.points[i];
    point.position += mean[static_cast<std::size_t>(groups.group[i])] - residual[i];
    const Vec3 variance = stated.of<PointMeasurement>()[i].cwiseAbs2().array() + excess * excess;
    point.sd = Vec3((variance / groups.size_of(i)).cwiseSqrt());
  }
}

/// One per block: whether it is the first of its group.
std::vector<bool> first_of_groups(const PoseSet& data, const RepeatedKinds& repeated) {
  std::array<std::set<int>, measurement_kinds> known;
  std::vector<bool> first;
  for (const Block& block : blocks_of(data)) {
    const auto kind = index(block.kind);
    first.push_back(repeated[kind].empty() ||
                    known[kind].insert(repeated[kind].group[static_cast<std::size_t>(block.index)]).second);
  }
  return first;
}

std::vector<int> measured_rows(const PoseSet& data) {
  std::set<int> rows;
  for (const Block& block : blocks_of(data)) rows.insert(block.row);
  return {rows.begin(), rows.end()};
}

}  // namespace

PoseMeans pose_means(const Chain& chain, const PoseSet& data, const std::optional<Instrument>& instrument,
                     ExcessNoise excess, int threads) {
  const RepeatedKinds repeated = repeated_measurements(data);
  if (std::ranges::all_of(repeated, &RepeatedMeasurements::empty)) return {data, excess, all_rows(data)};
  PoseSet means = data;
  const auto points = index(kind_of<PointMeasurement>);
  if (!repeated[points].empty()) {
    average_points(means, repeated[points], chain, weights_of(data, instrument.value_or(Instrument{})),
                   excess.of[points], threads);
    excess.of[points] = 0.0;
  }
  means = keep_measurements(means, first_of_groups(data, repeated));
  const std::vector<int> rows = measured_rows(means);
  return {select(means, rows), excess, rows};
}

}  // namespace kinfer::calibrate
