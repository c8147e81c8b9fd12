// SPDX-License-Identifier: Apache-2.0
// The classes that Python sees, and the functions that add them to the module.
#pragma once

#include "arrays.hpp"
#include "kinfer/evidence/facts/provenance.hpp"
#include "kinfer/io/robot/model_formats.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer::python {

/// kinfer.Robot: a robot file, or the corrected robot of a calibration.
struct Robot {
  RobotModel model;
  std::vector<std::string> paths{};  ///< of the file; empty: none
  ChainEnds ends{};
};

/// kinfer.PoseSet: a file of poses.
struct Poses {
  PoseSet set;
  std::vector<std::string> paths{};
  std::vector<std::pair<std::string, std::string>> options{};  ///< as the program states them
};

void add_robot(py::module_& module);
void add_calibration(py::module_& module);
void add_deployment(py::module_& module);
void add_identification(py::module_& module);
void add_tracking(py::module_& module);

/// Writes files into a folder, which is created; an error names the file.
void write_files(const std::string& folder, const std::vector<std::pair<std::string, std::string>>& files);

/// A path given as str or os.PathLike; none for other objects.
std::optional<std::string> path_of(const py::handle& object);

}  // namespace kinfer::python
