// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/prescribed_motion.hpp"

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/frame_motion.hpp"

namespace kinfer {

MachineMotion prescribed_motion(const Machine& machine, const Drive& drive, double sampling_rate) {
  return prescribed_motion(machine, drive.duration, sampling_rate, [&](double time) {
    std::vector<JointState> states;
    for (const JointTrajectory& joint : drive.joints) states.push_back(state_at(joint, time));
    return states;
  });
}

MachineMotion prescribed_motion(const Machine& machine, double duration, double sampling_rate,
                                const JointStates& states) {
  MachineMotion motion = make_motion(machine, row_count(duration, sampling_rate), sampling_rate);
  for (std::size_t row = 0; row < motion.time.size(); ++row) {
    const auto column = static_cast<Eigen::Index>(row);
    const std::vector<JointState> now = states(motion.time[row]);
    KINFER_EXPECT(static_cast<Eigen::Index>(now.size()) == motion.q.rows());
    for (std::size_t k = 0; k < now.size(); ++k) {
      const auto joint = static_cast<Eigen::Index>(k);
      motion.q(joint, column) = now[k].q;
      motion.qd(joint, column) = now[k].qd;
      motion.qdd(joint, column) = now[k].qdd;
    }
    const auto frames =
        joint_motions(machine.chain, motion.q.col(column), motion.qd.col(column), motion.qdd.col(column));
    for (std::size_t s = 0; s < machine.sensors.size(); ++s) {
      const MountedSensor& mounted = machine.sensors[s];
      const FrameMotion sensor = attached_frame_motion(frames[mounted.joint], mounted.segment_T_sensor);
      const Mat3 sensor_R_world = sensor.pose.rotation.transpose();
      SensorMotion& signals = motion.sensors[s];
      signals.world_R_sensor[row] = Quat(sensor.pose.rotation);
      signals.position[row] = sensor.pose.position;
      signals.force[row] = sensor_R_world * (sensor.acceleration - machine.chain.gravity);
      signals.angular_velocity[row] = sensor_R_world * sensor.omega;
      signals.field[row] = sensor_R_world * magnetic_field_world;
    }
  }
  return motion;
}

}  // namespace kinfer
