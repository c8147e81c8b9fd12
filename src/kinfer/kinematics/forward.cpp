#include "kinfer/kinematics/forward.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/elementary.hpp"

namespace kinfer {
namespace {

/// Walks through the factors of one joint from its parent's frame, noting the line it moves about or along.
struct Placer {
  PlacedJoint placed;
  double moved = 0.0;

  void operator()(const Mat3& rotation) { placed.frame.rotation *= rotation; }
  void operator()(const elementary::Factor& factor) {
    if (factor.moves) {
      placed.axis = placed.frame.rotation.col(factor.axis);
      placed.point = placed.frame.position;
    }
    elementary::apply(placed.frame, factor.motion, factor.axis, factor.moves ? factor.value + moved : factor.value);
  }
};

bool is_loaded(const Chain& chain, const Load& load) {
  const auto bends = [](const Joint& j) { return j.compliance != 0.0; };
  return (load.payload != 0.0 || !chain.masses.empty() || !load.gravity.empty()) &&
         std::any_of(chain.joints.begin(), chain.joints.end(), bends);
}

/// How far each joint has moved from its offset, deflection by gravity included.
VectorXd movements(const Chain& chain, ConstVectorRef q, const Load& load) {
  VectorXd moved = moved_by_readings(chain, q) + deviations(chain, q, load);
  if (!is_loaded(chain, load)) return moved;
  const VectorXd torques = load.gravity.empty() ? gravity_torques(chain, q, load)
                                                : VectorXd::Map(load.gravity.data(), moved.size()).eval();
  for (Eigen::Index j = 0; j < moved.size(); ++j) moved[j] += chain.joints[j].compliance * torques[j];
  return moved;
}

std::vector<PlacedJoint> place_joints(const Chain& chain, ConstVectorRef moved) {
  const Pose base = chain.base.pose();
  std::vector<PlacedJoint> placed(chain.joints.size());
  for (std::size_t j = 0; j < placed.size(); ++j) {
    const Joint& joint = chain.joints[j];
    placed[j] =
        place(joint.parent >= 0 ? placed[joint.parent].frame : base, joint, moved[static_cast<Eigen::Index>(j)]);
  }
  return placed;
}

/// The place of a point of the robot when all its lengths have grown.
Vec3 grown(const Chain& chain, const Load& load, const Vec3& point) {
  return point + chain.expansion * load.warming * (point - chain.base.xyz);
}

Pose tool_pose(const Chain& chain, const std::vector<PlacedJoint>& placed) {
  const int tip = chain.tip_joint();
  return (tip >= 0 ? placed[tip].frame : chain.base.pose()) * chain.tool.pose();
}

/// Change of the tool's pose by a unit movement of the joint.
Eigen::Matrix<double, 6, 1> screw(JointType type, const PlacedJoint& joint, const Vec3& tool) {
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();
  if (type == JointType::revolute) twist << joint.axis.cross(tool - joint.point), joint.axis;
  if (type == JointType::prismatic) twist.head<3>() = joint.axis;
  return twist;
}

}  // namespace

double value_or_zero(std::span<const double> values, int reading) {
  return values.empty() || std::isnan(values[reading]) ? 0.0 : values[reading];
}

std::vector<int> reading_indices(const Chain& chain) {
  std::vector<int> index(chain.joints.size(), -1);
  const std::vector<int> joints = joints_with_reading(chain);
  for (int k = 0; k < static_cast<int>(joints.size()); ++k) index[joints[k]] = k;
  return index;
}

VectorXd moved_by_readings(const Chain& chain, ConstVectorRef q) {
  KINFER_EXPECT(q.size() == dof(chain), "{} readings for {} joints that have one", q.size(), dof(chain));
  const std::vector<int> index = reading_indices(chain);
  VectorXd moved(chain.joints.size());
  for (Eigen::Index j = 0; j < moved.size(); ++j) {
    const Joint& joint = chain.joints[j];
    moved[j] = index[j] >= 0 ? joint.gain * q[index[j]] : 0.0;
    for (const Coupling& c : joint.couplings) moved[j] += c.factor * q[index[c.joint]];
  }
  return moved;
}

VectorXd deviations(const Chain& chain, ConstVectorRef q, const Load& load) {
  const std::vector<int> index = reading_indices(chain);
  VectorXd added = VectorXd::Zero(static_cast<Eigen::Index>(chain.joints.size()));
  for (Eigen::Index j = 0; j < added.size(); ++j) {
    const Joint& joint = chain.joints[j];
    const int k = index[j];
    if (k < 0) continue;
    for (const Harmonic& h : joint.harmonics)
      added[j] += h.sine * std::sin(h.order * q[k]) + h.cosine * std::cos(h.order * q[k]);
    added[j] += joint.torque_compliance * value_or_zero(load.torques, k);
    added[j] += joint.backlash * value_or_zero(load.approach, k);
  }
  return added;
}

PlacedJoint place(const Pose& parent, const Joint& joint, double moved) {
  Placer placer{{.frame = parent}, moved};
  elementary::for_each_factor(joint, placer);
  return placer.placed;
}

std::vector<PlacedJoint> placed_joints(const Chain& chain, ConstVectorRef q, const Load& load) {
  std::vector<PlacedJoint> placed = place_joints(chain, movements(chain, q, load));
  for (PlacedJoint& joint : placed) {
    joint.point = grown(chain, load, joint.point);
    joint.frame.position = grown(chain, load, joint.frame.position);
  }
  return placed;
}

Pose forward(const Chain& chain, ConstVectorRef q, const Load& load) {
  const VectorXd moved = movements(chain, q, load);
  Pose pose = chain.base.pose();
  for (const int j : path_to(chain, chain.tip_joint())) pose = place(pose, chain.joints[j], moved[j]).frame;
  pose.position = grown(chain, load, pose.position);
  return pose * chain.tool.pose();
}

std::vector<Pose> joint_frames(const Chain& chain, ConstVectorRef q, const Load& load) {
  std::vector<Pose> frames;
  for (const PlacedJoint& joint : placed_joints(chain, q, load)) frames.push_back(joint.frame);
  return frames;
}

Twists jacobian(const Chain& chain, ConstVectorRef q, const Load& load) {
  const std::vector<PlacedJoint> placed = placed_joints(chain, q, load);
  const Vec3 tool = tool_pose(chain, placed).position;
  const std::vector<int> index = reading_indices(chain);
  Twists twists = Twists::Zero(6, q.size());
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    const Eigen::Matrix<double, 6, 1> twist = screw(joint.type, placed[j], tool);
    if (index[j] >= 0) twists.col(index[j]) += joint.gain * twist;
    for (const Coupling& c : joint.couplings) twists.col(index[c.joint]) += c.factor * twist;
  }
  return twists;
}

VectorXd gravity_torques(const Chain& chain, ConstVectorRef q, const Load& load) {
  return gravity_torques(chain, place_joints(chain, moved_by_readings(chain, q)), load);
}

VectorXd gravity_torques(const Chain& chain, const std::vector<PlacedJoint>& placed, const Load& load) {
  VectorXd torques;
  gravity_torques(chain, placed, load, torques);
  return torques;
}

void gravity_torques(const Chain& chain, const std::vector<PlacedJoint>& placed, const Load& load, VectorXd& torques) {
  // Column j: mass at and beyond joint j, and its first moment about the world's origin.
  thread_local Eigen::Matrix4Xd burden;  // kept between calls: this runs at every pose of every fit
  burden.setZero(4, static_cast<Eigen::Index>(placed.size()));
  const auto carry = [&](int joint, double mass, const Vec3& at) { burden.col(joint) += mass * at.homogeneous(); };
  for (const PointMass& m : chain.masses) carry(m.joint, m.mass, placed[m.joint].frame * m.com);
  if (chain.tip_joint() >= 0) carry(chain.tip_joint(), load.payload, tool_pose(chain, placed).position);
  torques.setZero(burden.cols());
  for (Eigen::Index j = burden.cols() - 1; j >= 0; --j) {
    const Joint& joint = chain.joints[j];
    if (joint.type == JointType::revolute) {
      const Vec3 lever = burden.col(j).head<3>() - burden(3, j) * placed[j].point;  // [kg m]
      torques[j] = placed[j].axis.dot(lever.cross(chain.gravity));
    }
    if (joint.parent >= 0) burden.col(joint.parent) += burden.col(j);
  }
}

}  // namespace kinfer
