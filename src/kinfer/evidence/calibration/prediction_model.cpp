// SPDX-License-Identifier: Apache-2.0
#include "kinfer/evidence/calibration/prediction_model.hpp"

#include <cmath>

namespace kinfer {

double region_distance(const PredictionModel& model, ConstVectorRef q) {
  if (model.rows.cols() == 0) return 0.0;
  const VectorXd scale = model.spread.cwiseInverse();
  return std::sqrt((scale.asDiagonal() * (model.rows.colwise() - VectorXd(q))).colwise().squaredNorm().minCoeff()) /
         model.reach;
}

double model_error_growth(const PredictionModel& model, ConstVectorRef q) {
  const double distance = region_distance(model, q);
  return 1.0 + model.rate * distance * distance;
}

}  // namespace kinfer
