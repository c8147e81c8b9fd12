// One sensor's readings in one interval as whitened, robustly weighted rows, with their derivatives by all that they
// depend on.
#pragma once

#include "kinfer/estimate/ins_motion.hpp"

namespace kinfer {

/// Unknowns that one sensor's readings depend on: coefficients of its path's channels, then its path's and its own
/// unknowns of the border.
struct SensorColumns {
  std::vector<Eigen::Index> index;  ///< in the span: i·channels + channel; then reach·channels + border unknown
  std::vector<Eigen::Index>
      of_state;                  ///< for each state column: first of its coefficients' columns, or its border column
  Eigen::Index path_border = 0;  ///< column of the first of the path's border unknowns
  Eigen::Index own = 0;          ///< column of the first of the sensor's errors
};
SensorColumns sensor_columns(const InsLayout& layout, const InsPaths& paths, std::size_t body, std::size_t sensor);

struct SensorSystem {
  MatrixXd jacobian;  ///< rows x columns
  VectorXd residual;
};
SensorSystem sensor_system(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                           const SensorColumns& columns, const std::vector<InsColumn>& path, std::size_t body,
                           Eigen::Index interval, const std::array<NodeMotion, block_nodes>& motion,
                           const std::array<SplineBasis, block_nodes>& bases);

}  // namespace kinfer
