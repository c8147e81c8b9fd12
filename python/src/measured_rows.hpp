// SPDX-License-Identifier: Apache-2.0
// Arrays of measurements as a pose set.
#pragma once

#include "arrays.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::python {

/// The arguments of kinfer.calibrate that are measurements.
struct MeasuredArguments {
  py::object positions, poses, distances, anchors, sockets, sd, sd_angle, setup;
};

/// Errors name the argument, and the row from 0.
PoseSet measured_rows(const py::handle& joints, const Chain& chain, const MeasuredArguments& given);

/// One number `sd` is the accuracy of the instrument; else that of the robot file.
std::optional<Instrument> instrument_of(const MeasuredArguments& given, const RobotModel& robot);

}  // namespace kinfer::python
