// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/pose_set.hpp"

#include <cmath>

#include "kinfer/geometry/random.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

VectorXd draw_joints(const Chain& chain, const std::vector<int>& moving, Rng& rng) {
  VectorXd q(static_cast<Eigen::Index>(moving.size()));
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const Joint& joint = chain.joints[moving[k]];
    const bool is_revolute = rotates(joint.type);
    const double low = std::isfinite(joint.lower) ? joint.lower : is_revolute ? -170.0 * degree : 0.0;
    const double high = std::isfinite(joint.upper) ? joint.upper : is_revolute ? 170.0 * degree : 0.3;
    q[static_cast<Eigen::Index>(k)] = rng.uniform(low, high);
  }
  return q;
}

bool in_space(const Chain& chain, const Vec3& tool_in_world, const PoseSpace& space) {
  const Vec3 p = chain.base.pose().inverse() * tool_in_world;
  return p.z() > space.lowest && p.head<2>().norm() > space.clearance;
}

Vec3 noise(Rng& rng, double sd) {
  return sd * normal_vector(rng);
}

/// Measures a pose with independent errors from a stand at the world origin that has rotated by w: this adds w × p to
/// the position error and w to the orientation error.
void measure_from_shaking_stand(PoseSet& set, int row, const Pose& world_T_tool, const PoseSimulation& simulation,
                                Rng& draws) {
  const Vec3& p = world_T_tool.position;
  const double sd = position_sd(simulation.instrument, p), turn_sd = simulation.instrument.sigma_angle;
  const Vec3 moved = noise(draws, sd), turned = noise(draws, turn_sd), shaken = noise(draws, simulation.shake);
  const Mat3 lever = -skew(p);  // d(w × p) = lever w
  const double variance = simulation.shake * simulation.shake;
  const PrincipalDeviations spread =
      principal_deviations(sd * sd * Mat3::Identity() + variance * lever * lever.transpose());
  set.points.push_back({row, -1, exp_so3(shaken) * p + moved, spread.sd, spread.axes});
  set.orientations.push_back({.row = row,
                              .orientation = quat_exp(shaken) * quat_exp(turned) * Quat(world_T_tool.rotation),
                              .sd = Vec3::Constant(std::hypot(turn_sd, simulation.shake)),
                              .covariance_with_point = Mat3(variance * lever)});
}

}  // namespace

Chain with_random_errors(const Chain& nominal, const Tolerances& tolerances, Rng rng) {
  Chain truth = nominal;
  for (const Parameter& parameter : all_parameters(nominal, tolerances).parameters) {
    if (parameter.quantity == Quantity::compliance) continue;
    const JointNumber* number = joint_number(parameter.at);
    const bool revolute_gain = number && number->field == Field::gain && rotates(nominal.joints[number->joint].type);
    const bool coupling = number && number->field == Field::coupling;
    if (revolute_gain || coupling) continue;  // an encoder's gain is exact unless a user says otherwise
    set_value_at(truth, parameter.at, parameter.nominal + parameter.prior_sd * rng.normal());
  }
  return truth;
}

PoseSet simulate_points(const Chain& truth, const MatrixXd& joints, const Instrument& instrument, Rng rng) {
  const PoseEvaluator evaluator(truth, {});
  PoseSet set;
  set.joint_names = active_joint_names(truth);
  set.joints = joints;
  for (int row = 0; row < joints.cols(); ++row) {
    const Vec3 p = evaluator.pose(joints.col(row)).position;
    set.points.push_back({.row = row, .target = -1, .position = p + noise(rng, position_sd(instrument, p)), .sd = {}});
    set.line.push_back(row + 2);
  }
  return set;
}

Result<PoseSet> simulate_pose_set(const Chain& truth, const PoseSimulation& simulation, Rng rng) {
  const Instrument& instrument = simulation.instrument;
  if (simulation.shake > 0.0 && !(instrument.sigma > 0.0 && instrument.sigma_angle > 0.0))
    return error(
        "a shaking stand needs an instrument whose own standard deviations of position and angle are larger than 0");
  const std::vector<int> moving = active_joints(truth);
  const PoseEvaluator evaluator(truth, {});
  PoseSet set;
  set.joint_names = active_joint_names(truth);
  set.joints.resize(static_cast<Eigen::Index>(moving.size()), simulation.poses);
  for (int row = 0; row < simulation.poses; ++row) {
    Rng draws = rng.stream(row);
    constexpr int patience = 10000;
    VectorXd q;
    Pose pose;
    int tries = 0;
    do {
      if (++tries > patience)
        return error(
            "none of {} random poses keeps the tool {}{} m away from the base axis", patience,
            std::isfinite(simulation.space.lowest) ? fmt::format("above {} m and ", simulation.space.lowest) : "",
            simulation.space.clearance);
      q = draw_joints(truth, moving, draws);
      pose = evaluator.pose(q);
    } while (!in_space(truth, pose.position, simulation.space));
    set.joints.col(row) = q;
    set.line.push_back(row + 2);
    if (simulation.shake > 0.0) {
      measure_from_shaking_stand(set, row, pose, simulation, draws);
      continue;
    }
    const double sd = position_sd(simulation.instrument, pose.position);
    set.points.push_back({.row = row, .target = -1, .position = pose.position + noise(draws, sd), .sd = {}});
    if (simulation.measured == Measured::poses) {
      const Quat turned = quat_exp(noise(draws, simulation.instrument.sigma_angle)) * Quat(pose.rotation);
      set.orientations.push_back({row, turned, {}});
    }
  }
  return set;
}

}  // namespace kinfer
