// SPDX-License-Identifier: Apache-2.0
// Motions of segments that are measured without error, from known frame states.
#pragma once

#include "identify/example_machine.hpp"
#include "kinfer/identify/structure/segment_tree.hpp"

namespace kinfer::test {

inline SegmentMotion measured_segment(const std::string& name, const std::vector<FrameState>& states) {
  SegmentMotion segment{
      .name = name, .rotation = {}, .gyro = {}, .angular_velocity = {}, .angular_acceleration = {}, .acceleration = {}};
  for (const FrameState& s : states) {
    segment.rotation.push_back(s.rotation);
    segment.gyro.push_back(s.rotation.transpose() * s.angular_velocity);
    segment.angular_velocity.push_back(s.angular_velocity);
    segment.angular_acceleration.push_back(s.angular_acceleration);
    segment.acceleration.push_back(s.acceleration);
  }
  return segment;
}

/// At 100 Hz.
inline RecordedMotion recorded_motion(std::vector<SegmentMotion> segments) {
  RecordedMotion motion;
  motion.period = 0.01;
  for (std::size_t row = 0; row < segments.front().rotation.size(); ++row)
    motion.time.push_back(0.01 * static_cast<double>(row));
  motion.usable.assign(motion.time.size(), true);
  motion.segments = std::move(segments);
  return motion;
}

/// Three joint variables that are not correlated.
inline const std::vector<JointSignal>& three_signals() {
  static const std::vector<JointSignal> signals{wave(0.6, 0.9, 1.0), wave(0.4, 1.3, 0.2), wave(0.5, 0.5, 2.0)};
  return signals;
}

/// A segment that rotates about three axes and is carried along, `phase` [rad] sets one such motion apart from another.
inline std::vector<FrameState> freely_moving(double phase = 0.0) {
  const std::vector<JointSignal> signals{wave(0.7, 0.6, phase), wave(0.5, 0.8, 1.0 + phase), wave(0.6, 0.45, phase)};
  const std::vector<DhLeaf> leaves{{.alpha = 1.3, .a = 0.4, .theta_signal = 0},
                                   {.d = 0.3, .alpha = -1.2, .theta_signal = 1},
                                   {.a = 0.2, .theta_signal = 2}};
  return propagate(std::vector<FrameState>(signals[0].angle.size()), leaves, signals);
}

inline std::vector<FrameState> at_rest() {
  return std::vector<FrameState>(600);
}

/// The world frame of a segment's orientation estimate, rotated about the vertical [rad].
inline void rotate_world(SegmentMotion& segment, double heading) {
  const Mat3 turn = rot_z(heading);
  for (Mat3& r : segment.rotation) r = turn * r;
  for (auto* vectors : {&segment.angular_velocity, &segment.angular_acceleration, &segment.acceleration})
    for (Vec3& v : *vectors) v = turn * v;
}

/// A chain of segments a, b, c, …, each behind `leaves` and one of the three signals of the segment before.
inline RecordedMotion serial_machine(std::vector<FrameState> root, std::size_t segments,
                                     const std::vector<DhLeaf>& leaves) {
  std::vector<SegmentMotion> list;
  for (std::size_t i = 0; i < segments; ++i) {
    if (i > 0) root = propagate(root, leaves, {&three_signals()[(i - 1) % 3], 1});
    list.push_back(measured_segment(std::string(1, static_cast<char>('a' + i)), root));
  }
  return recorded_motion(std::move(list));
}

}  // namespace kinfer::test
