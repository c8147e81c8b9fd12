// SPDX-License-Identifier: Apache-2.0
#include "kinfer/deploy/predict.hpp"

#include <algorithm>

#include "kinfer/calibrate/start/fixtures.hpp"
#include "kinfer/deploy/thresholds.hpp"

namespace kinfer::deploy {

Result<std::vector<Pose>> predict_poses(const Chain& chain, const PoseSet& rows,
                                        const std::optional<PredictionModel>& model) {
  KINFER_TRY(placed, calibrate::with_fixtures(chain, rows));
  return predicted_poses(placed.chain, model, with_approach(placed.data));
}

Result<std::vector<PoseUncertainty>> predict_uncertainties(const Chain& chain, const PredictionModel& model,
                                                           const PoseSet& rows) {
  KINFER_TRY(placed, calibrate::with_fixtures(chain, rows));
  return pose_uncertainties(placed.chain, model, with_approach(placed.data));
}

std::optional<Finding> find_rows_outside(const PredictionModel& model, const PoseSet& rows) {
  Finding finding{.kind = FindingKind::outside_region, .severity = Severity::warning};
  double largest = 0.0;
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const double distance = region_distance(model, rows.joints.col(row));
    if (distance <= thresholds::outside_distance) continue;
    finding.rows.push_back(static_cast<int>(row));
    if (!rows.line.empty()) finding.lines.push_back(rows.line[static_cast<std::size_t>(row)]);
    largest = std::max(largest, distance);
  }
  if (finding.rows.empty()) return std::nullopt;
  finding.values.set("largest_distance", largest);
  return finding;
}

}  // namespace kinfer::deploy
