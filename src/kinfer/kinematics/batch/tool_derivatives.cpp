// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/tool_derivatives.hpp"

#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

ToolDerivatives sequential_derivatives(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints) {
  ToolDerivatives tool{Eigen::Matrix3Xd(3, joints.cols()), MatrixXd(3 * joints.cols(), set.free_count())};
  const PoseEvaluator evaluator(chain, set);
  Twists twists;
  for (Eigen::Index i = 0; i < joints.cols(); ++i) {
    tool.position.col(i) = evaluator.pose_and_derivative(joints.col(i), {}, twists).position;
    tool.jacobian.middleRows<3>(3 * i) = twists.topRows<3>();
  }
  return tool;
}

/// The kernels give errors, measured − predicted: with the origin as measurement, the negative tool position.
ToolDerivatives batch_derivatives(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints) {
  const Eigen::Matrix3Xd origin = Eigen::Matrix3Xd::Zero(3, joints.cols()), one = origin.array() + 1.0;
  const BatchPoints points(chain, set, {joints, origin});
  VectorXd error(3 * joints.cols());
  MatrixXd jacobian(error.size(), points.unknowns());
  BatchPoints::Scratch scratch;
  points.residuals(pack(set, chain), points.weights(one), error, jacobian, scratch);
  return {-error.reshaped(3, joints.cols()), -jacobian};
}

}  // namespace

ToolDerivatives tool_derivatives(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints) {
  return has_batch_form(chain, set) ? batch_derivatives(chain, set, joints)
                                    : sequential_derivatives(chain, set, joints);
}

}  // namespace kinfer
