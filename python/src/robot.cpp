// SPDX-License-Identifier: Apache-2.0
#include "robot.hpp"

#include "kinfer/base/version.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/kinematics/poses/tool_poses.hpp"

namespace kinfer::python {
namespace {

Robot load_robot(const py::object& file, const std::string& base, const std::string& tip) {
  const auto path = path_of(file);
  if (!path) throw InputError("Robot.load: expected the path of a file");
  const ChainEnds ends{base, tip};
  return {value_of(read_robot_model(*path, ends)), {*path}, ends};
}

py::array forward_of(const Robot& robot, const py::handle& joints, int threads) {
  const Chain& chain = robot.model.chain;
  const Numbers q = joint_positions(joints, chain);
  const bool one = numbers(joints, "joints").ndim() == 1;
  py::array_t<double> poses({q.shape(0), py::ssize_t{4}, py::ssize_t{4}});
  const std::span<double> target(poses.mutable_data(), static_cast<std::size_t>(poses.size()));
  const auto columns = as_columns(q);
  {
    const py::gil_scoped_release without_lock;
    tool_poses(chain, columns, target, threads);
  }
  return one ? py::array(poses[py::int_(0)]) : poses;
}

py::array limits_of(const Robot& robot) {
  const Chain& chain = robot.model.chain;
  MatrixXd limits(dof(chain), 2);
  for (Eigen::Index k = 0; const int j : active_joints(chain))
    limits.row(k++) << chain.joints[j].lower, chain.joints[j].upper;
  return array_of(limits);
}

Poses read_poses(const py::object& file, const Robot& robot, const std::optional<std::string>& columns) {
  const auto path = path_of(file);
  if (!path) throw InputError("read_poses: expected the path of a file");
  const ColumnMap map = columns ? value_of(read_column_map(*columns)) : ColumnMap{};
  Poses poses{value_of(read_pose_set(*path, robot.model.chain, map)), {*path}};
  if (columns) {
    poses.paths.push_back(*columns);
    poses.options.emplace_back("--columns", std::filesystem::path(*columns).filename().string());
  }
  return poses;
}

}  // namespace

std::optional<std::string> path_of(const py::handle& object) {
  if (!py::isinstance<py::str>(object) && !py::hasattr(object, "__fspath__")) return std::nullopt;
  return py::str(py::module_::import("os").attr("fspath")(object)).cast<std::string>();
}

void write_files(const std::string& folder, const std::vector<std::pair<std::string, std::string>>& files) {
  value_of(create_writable_folder(folder));
  for (const auto& [name, text] : files) value_of(write_text_file(std::filesystem::path(folder) / name, text));
}

void add_robot(py::module_& module) {
  py::class_<Robot>(module, "Robot", "A kinematic model: a chain of joints from a base to a tool.")
      .def_static(
          "load", &load_robot, py::arg("path"), py::kw_only(), py::arg("base") = "", py::arg("tip") = "",
          "Reads a robot file: TOML, URDF or MJCF. base, tip: links of a URDF file, bodies (tip: or a site) of an MJCF "
          "file, between which the chain lies (default: its root; the tool in a file that kinfer wrote, else the end "
          "of its longest arm).")
      .def(
          "forward", &forward_of, py::arg("joints"), py::kw_only(), py::arg("threads") = 0,
          "Tool poses, (n, 4, 4) homogeneous matrices [m], at joint positions (n, dof) [rad] or [m]; (4, 4) at (dof,). "
          "Arrays in C order are not copied.")
      .def(
          "save",
          [](const Robot& robot, const py::object& file) {
            value_of(write_robot_model(path_of(file).value_or(""), robot.model));
          },
          py::arg("path"), "Writes the model: .toml, .urdf or .mjcf.")
      .def_property_readonly("name", [](const Robot& robot) { return robot.model.chain.name; })
      .def_property_readonly("dof", [](const Robot& robot) { return dof(robot.model.chain); })
      .def_property_readonly("joint_names", [](const Robot& robot) { return active_joint_names(robot.model.chain); })
      .def_property_readonly("limits", &limits_of, "(dof, 2) lower and upper limits [rad] or [m], infinite where open")
      .def_property_readonly(
          "base", [](const Robot& robot) { return matrix_of(robot.model.chain.base.pose()); },
          "(4, 4) world_T_base [m]")
      .def_property_readonly(
          "tool", [](const Robot& robot) { return matrix_of(robot.model.chain.tool.pose()); },
          "(4, 4) flange_T_tool [m]")
      .def("__repr__", [](const Robot& robot) {
        return fmt::format("<kinfer.Robot \"{}\", {} joints>", robot.model.chain.name, dof(robot.model.chain));
      });
  py::class_<Poses>(module, "PoseSet", "Joint positions and measurements, row by row, as read from a file.")
      .def("__len__", [](const Poses& poses) { return poses.set.rows(); })
      .def_property_readonly(
          "joints", [](const Poses& poses) { return array_of(poses.set.joints.transpose()); },
          "(n, dof) joint positions [rad] or [m]");
  module.def("read_poses", &read_poses, py::arg("path"), py::arg("robot"), py::kw_only(),
             py::arg("columns") = py::none(),
             "Reads a pose set (CSV) for a robot; columns: a column map (TOML) of a foreign file.");
}

}  // namespace kinfer::python

PYBIND11_MODULE(_kinfer, module) {
  using namespace kinfer::python;
  module.doc() = "From raw measurements to a proven kinematic model.";
  module.attr("__version__") = kinfer::version;
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  add_robot(module);
  add_calibration(module);
  add_deployment(module);
  add_identification(module);
  add_tracking(module);
}
