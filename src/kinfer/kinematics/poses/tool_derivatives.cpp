// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/tool_derivatives.hpp"

#include <vector>

#include "kinfer/kinematics/batch/batch_points.hpp"
#include "kinfer/kinematics/poses/batch_poses.hpp"

namespace kinfer {
namespace {

ToolDerivatives derivatives_of_any_chain(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints) {
  ToolDerivatives tool{Eigen::Matrix3Xd(3, joints.cols()), MatrixXd(3 * joints.cols(), set.free_count())};
  std::vector<Pose> poses(static_cast<std::size_t>(joints.cols()));
  std::vector<Twists> twists(poses.size());
  std::vector<PoseRow> rows;
  for (std::size_t i = 0; i < poses.size(); ++i)
    rows.push_back({.q = joints.col(static_cast<Eigen::Index>(i)).data(), .pose = &poses[i], .twists = &twists[i]});
  BatchPoses::Scratch scratch;
  BatchPoses(chain, set).evaluate(rows, scratch);
  for (Eigen::Index i = 0; i < joints.cols(); ++i) {
    tool.position.col(i) = poses[static_cast<std::size_t>(i)].position;
    tool.jacobian.middleRows<3>(3 * i) = twists[static_cast<std::size_t>(i)].topRows<3>();
  }
  return tool;
}

/// The kernels give errors, measured − predicted: with the origin as measurement, the negative tool position.
ToolDerivatives derivatives_of_points(const Chain& chain, const ParameterSet& set, ConstMatrixRef joints) {
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
  return has_batch_form(chain, set) ? derivatives_of_points(chain, set, joints)
                                    : derivatives_of_any_chain(chain, set, joints);
}

}  // namespace kinfer
