// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/findings/motion_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "kinfer/base/expect.hpp"
#include "kinfer/identify/findings/thresholds.hpp"
#include "kinfer/identify/refinement/joints/joint_trajectory.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer::identify {
namespace {

/// Three axes of one signal at every row, NaN if the row is not usable.
using Signals = std::array<std::vector<double>, 3>;

template <class Vector>
Signals axes_of(const RecordedMotion& motion, Vector vector_at) {
  Signals axes;
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    const Vec3 v = motion.usable[row] ? vector_at(row) : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (Eigen::Index k = 0; k < 3; ++k) axes[static_cast<std::size_t>(k)].push_back(v[k]);
  }
  return axes;
}

/// Vector rms over the rows where `marked` has this value.
double rms(const Signals& axes, const std::vector<bool>& marked, bool value) {
  double sum = 0.0, count = 0.0;
  for (std::size_t row = 0; row < axes[0].size(); ++row) {
    const double square = axes[0][row] * axes[0][row] + axes[1][row] * axes[1][row] + axes[2][row] * axes[2][row];
    if (marked[row] == value && std::isfinite(square)) sum += square, count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

std::vector<bool> rows_in(const std::vector<double>& time, const std::vector<TimeWindow>& windows) {
  std::vector<bool> inside;
  for (const double t : time)
    inside.push_back(std::ranges::any_of(windows, [t](const TimeWindow& w) { return t >= w.begin && t < w.end; }));
  return inside;
}

/// `is_held_out`: rows of the held-out windows; `held_out_prediction`: there, by the chain fitted without them.
template <class Measured, class Predicted>
Trace trace_of(const RecordedMotion& motion, Trace trace, const std::vector<bool>& is_held_out, Measured measured,
               Predicted predicted, Predicted held_out_prediction) {
  const Binning bins = binning(motion.rows(), max_trace_bins);
  const Signals m = axes_of(motion, measured), p = axes_of(motion, predicted);
  const Signals r = axes_of(motion, [&](std::size_t row) -> Vec3 { return measured(row) - predicted(row); });
  for (std::size_t k = 0; k < 3; ++k) {
    trace.measured[k] = envelope(m[k], bins);
    trace.predicted[k] = envelope(p[k], bins);
    trace.residual[k] = envelope(r[k], bins);
  }
  const std::vector<bool> all(motion.rows(), true);
  trace.rms_measured = rms(m, all, true);
  trace.rms_fitted = rms(r, is_held_out, false);
  trace.rms_holdout =
      rms(axes_of(motion, [&](std::size_t row) -> Vec3 { return measured(row) - held_out_prediction(row); }),
          is_held_out, true);
  return trace;
}

/// Predicted acceleration and angular velocity of a segment's sensor in the world, one per row.
struct PredictedSignals {
  std::vector<Vec3> acceleration, angular_velocity;
};

std::size_t index_of_segment(const RecordedMotion& motion, const std::string& sensor) {
  return static_cast<std::size_t>(std::ranges::find(motion.segments, sensor, &SegmentMotion::name) -
                                  motion.segments.begin());
}

/// Acceleration of a point of the segment minus that of its sensor; `lever`: the point in the sensor's frame.
Vec3 lever_acceleration(const SegmentMotion& segment, std::size_t row, const Vec3& lever) {
  const Vec3 arm = segment.rotation[row] * lever, &angular_velocity = segment.angular_velocity[row];
  return segment.angular_acceleration[row].cross(arm) + angular_velocity.cross(angular_velocity.cross(arm));
}

Vec3 along(const Vec3& axis, const Vec3& v) {
  return axis.dot(v) * axis;
}

PredictedSignals propagate_signals(const JointEstimate& joint, const SegmentMotion& parent, const SegmentMotion& child,
                                   const PredictedSignals& previous) {
  PredictedSignals result;
  for (std::size_t row = 0; row < parent.angular_velocity.size(); ++row) {
    const Vec3 axis = parent.rotation[row] * joint.axis_in_parent;
    Vec3 acceleration = previous.acceleration[row] + lever_acceleration(parent, row, joint.point_in_parent) -
                        lever_acceleration(child, row, joint.point_in_child);
    Vec3 angular_velocity = previous.angular_velocity[row];
    if (joint.type == EstimatedJointType::prismatic)
      acceleration += along(axis, child.acceleration[row] - acceleration);
    if (joint.type == EstimatedJointType::revolute)
      angular_velocity += along(axis, child.angular_velocity[row] - angular_velocity);
    else if (joint.type != EstimatedJointType::prismatic && joint.type != EstimatedJointType::rigid)
      angular_velocity =
          child.angular_velocity[row];  // rotates about several axes: compatible with any angular velocity
    result.acceleration.push_back(acceleration);
    result.angular_velocity.push_back(angular_velocity);
  }
  return result;
}

using PredictedMotion = std::map<std::string, PredictedSignals>;

/// Of every segment reached by the joints.
PredictedMotion predictions_of(const RecordedMotion& motion, const std::string& root_name,
                               const std::vector<JointEstimate>& joints) {
  const SegmentMotion& root = motion.segments[index_of_segment(motion, root_name)];
  PredictedMotion predictions{{root_name, {root.acceleration, root.angular_velocity}}};
  for (const JointEstimate& joint : joints)
    predictions[joint.child] =
        propagate_signals(joint, motion.segments[index_of_segment(motion, joint.parent)],
                          motion.segments[index_of_segment(motion, joint.child)], predictions.at(joint.parent));
  return predictions;
}

void add_traces(MotionEvidence& evidence, const RecordedMotion& motion, const SegmentMotion& segment,
                const std::vector<bool>& is_held_out, const PredictedSignals& prediction,
                const PredictedSignals& held_out_prediction_of) {
  const auto add = [&](TraceQuantity quantity, const std::vector<Vec3>& measured, const std::vector<Vec3>& predicted,
                       const std::vector<Vec3>& held_out_prediction) {
    const auto of = [](const std::vector<Vec3>& rows) {
      return [&rows](std::size_t row) -> Vec3 { return rows[row]; };
    };
    Trace trace{.sensor = segment.name, .quantity = quantity, .frame = TraceFrame::world};
    evidence.traces.push_back(
        trace_of(motion, std::move(trace), is_held_out, of(measured), of(predicted), of(held_out_prediction)));
  };
  add(TraceQuantity::acceleration, segment.acceleration, prediction.acceleration, held_out_prediction_of.acceleration);
  add(TraceQuantity::angular_velocity, segment.angular_velocity, prediction.angular_velocity,
      held_out_prediction_of.angular_velocity);
}

std::vector<double> middles(const std::vector<double>& time, const Binning& bins) {
  std::vector<double> middle;
  for (std::size_t i = 0; i < time.size(); i += bins.size)
    middle.push_back(0.5 * (time[i] + time[std::min(i + bins.size, time.size()) - 1]));
  return middle;
}

int frame_named(const Chain& chain, const std::string& name) {
  const auto found = std::ranges::find(chain.joints, name, &Joint::name);
  return found == chain.joints.end() ? -1 : static_cast<int>(found - chain.joints.begin());
}

/// Angle of the revolute joint nearest to the child's orientation in the parent.
double revolute_angle_at(const Vec3& axis_in_parent, const Mat3& home, const Mat3& parent, const Mat3& child) {
  const Quat turn(Mat3(parent.transpose() * child * home.transpose()));
  return 2.0 * std::atan2(axis_in_parent.dot(turn.vec()), turn.w());
}

/// The angle plus whole revolutions, nearest to the one before (unwrapping).
double unwrapped(double angle, double previous) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return angle + turn * std::round((previous - angle) / turn);
}

void fill_joint_positions(MatrixXd& q, Eigen::Index variable_row, const JointEstimate& joint, const Mat3& home,
                          const SegmentMotion& parent, const SegmentMotion& child, std::size_t step) {
  double previous = 0.0;
  for (Eigen::Index k = 0; k < q.cols(); ++k) {
    const std::size_t row = static_cast<std::size_t>(k) * step;
    previous =
        unwrapped(revolute_angle_at(joint.axis_in_parent, home, parent.rotation[row], child.rotation[row]), previous);
    q(variable_row, k) = previous;
  }
}

/// Number of joint variables in the chain.
Eigen::Index variable_count(EstimatedJointType type) {
  switch (type) {
    case EstimatedJointType::rigid:
      return 0;
    case EstimatedJointType::universal:
      return 2;
    case EstimatedJointType::spherical:
      return 3;
    case EstimatedJointType::revolute:
    case EstimatedJointType::prismatic:
      break;
  }
  return 1;
}

MachineTrajectory machine_trajectory(const RecordedMotion& motion, const Identification& found) {
  const Binning bins = trajectory_frames(motion);
  const std::vector<int> variable_joints = active_joints(found.chain);
  const std::vector<Pose> home = joint_frames(found.chain, VectorXd::Zero(dof(found.chain)));
  MachineTrajectory trajectory;
  trajectory.q = MatrixXd::Zero(dof(found.chain), static_cast<Eigen::Index>(bins.count()));
  const SegmentMotion& root = motion.segments[index_of_segment(motion, found.root)];
  trajectory.time = trajectory_times(motion);
  for (std::size_t row = 0; row < motion.rows(); row += bins.size) {
    const Quat r(root.rotation[row]);
    trajectory.root.push_back({r.w(), r.x(), r.y(), r.z()});
  }
  if (root.still) trajectory.root.resize(1);
  Eigen::Index row = 0;
  for (const JointEstimate& joint : found.joints) {  // their variables have the same order in the chain
    const Eigen::Index variables = variable_count(joint.type);
    if (joint.trajectory.size() > 0) {
      KINFER_EXPECT(joint.trajectory.rows() == variables && joint.trajectory.cols() == trajectory.q.cols(),
                    "a trajectory of {} x {} for {}", joint.trajectory.rows(), joint.trajectory.cols(),
                    joint_name(joint));
      trajectory.q.middleRows(row, variables) = joint.trajectory;
    }
    row += variables;
  }
  for (std::size_t k = 0; k < variable_joints.size(); ++k) {
    const std::string& name = found.chain.joints[variable_joints[k]].name;
    const auto joint =
        std::ranges::find_if(found.joints, [&](const JointEstimate& j) { return joint_name(j) == name; });
    if (joint == found.joints.end() || joint->type != EstimatedJointType::revolute || joint->trajectory.size() > 0)
      continue;
    const int parent = frame_named(found.chain, joint->parent), child = frame_named(found.chain, joint->child);
    const Mat3 parent_home = parent < 0 ? found.chain.base.pose().rotation : home[parent].rotation;
    fill_joint_positions(trajectory.q, static_cast<Eigen::Index>(k), *joint,
                         parent_home.transpose() * home[child].rotation,
                         motion.segments[index_of_segment(motion, joint->parent)],
                         motion.segments[index_of_segment(motion, joint->child)], bins.size);
  }
  return trajectory;
}

}  // namespace

MotionEvidence motion_evidence(const RecordedMotion& motion, const Identification& found, const HeldOut& held) {
  MotionEvidence evidence;
  evidence.time = middles(motion.time, binning(motion.rows(), max_trace_bins));
  evidence.held_out = held.windows;
  const std::vector<bool> is_held_out = rows_in(motion.time, held.windows);
  const PredictedMotion fitted_prediction = predictions_of(motion, found.root, found.joints),
                        held_out_prediction =
                            predictions_of(motion, found.root, held.windows.empty() ? found.joints : held.joints);
  for (const JointEstimate& joint : found.joints)
    add_traces(evidence, motion, motion.segments[index_of_segment(motion, joint.child)], is_held_out,
               fitted_prediction.at(joint.child), held_out_prediction.at(joint.child));
  evidence.trajectory = machine_trajectory(motion, found);
  return evidence;
}

}  // namespace kinfer::identify
