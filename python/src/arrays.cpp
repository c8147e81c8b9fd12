// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <algorithm>
#include <cmath>

namespace kinfer::python {
namespace {

std::string shape_of(const Numbers& values) {
  std::string text = "(";
  for (py::ssize_t k = 0; k < values.ndim(); ++k) text += fmt::format("{}{}", k ? ", " : "", values.shape(k));
  return text + (values.ndim() == 1 ? ",)" : ")");
}

/// The same numbers with another shape, without a copy.
Numbers reshaped(const Numbers& values, std::vector<py::ssize_t> shape) {
  return Numbers(values.attr("reshape")(py::cast(std::move(shape))));
}

std::vector<std::string> column_names(const py::handle& frame) {
  std::vector<std::string> names;
  for (const py::handle column : frame.attr("columns")) names.push_back(py::str(column));
  return names;
}

bool contains_all(const std::vector<std::string>& names, const std::vector<std::string>& wanted) {
  return std::ranges::all_of(wanted, [&](const auto& name) { return std::ranges::count(names, name) == 1; });
}

/// The columns of a DataFrame that are joint positions; other values as they are.
py::object joint_columns(const py::handle& values, const Chain& chain) {
  if (!py::hasattr(values, "columns")) return py::reinterpret_borrow<py::object>(values);
  const std::vector<std::string> names = column_names(values), joints = active_joint_names(chain);
  std::vector<std::string> numbered, prefixed;
  for (std::size_t k = 0; k < joints.size(); ++k)
    numbered.push_back(fmt::format("q{}", k + 1)), prefixed.push_back("q_" + joints[k]);
  for (const auto& wanted : {joints, prefixed, numbered})
    if (contains_all(names, wanted)) return values[py::cast(wanted)];
  return py::reinterpret_borrow<py::object>(values);
}

/// The median of the revolute joints' largest angles is beyond any robot's, whose cables turn twice at most.
bool seem_degrees(const Numbers& q, const Chain& chain) {
  constexpr double two_turns = 4.0 * 3.14159265358979;
  std::vector<double> largest;
  const std::vector<int> joints = active_joints(chain);
  for (std::size_t k = 0; k < joints.size(); ++k)
    if (rotates(chain.joints[joints[k]].type))
      largest.push_back(as_columns(q).row(static_cast<Eigen::Index>(k)).cwiseAbs().maxCoeff());
  if (largest.empty()) return false;
  std::ranges::sort(largest);
  return largest[largest.size() / 2] > two_turns;
}

}  // namespace

Numbers numbers(const py::handle& values, const std::string& name) {
  // Without this, numpy would turn texts, times and complex numbers into doubles.
  constexpr std::string_view kinds_of_numbers = "biufO";
  const auto any = py::array::ensure(values);
  if (any && kinds_of_numbers.find(any.dtype().kind()) != std::string_view::npos)
    if (auto array = Numbers::ensure(any)) return array;
  PyErr_Clear();
  throw InputError(fmt::format("{}: expected an array of numbers, found {}", name,
                               std::string(py::str(py::type::of(values).attr("__name__")))));
}

Numbers table(const py::handle& values, const std::string& name, Eigen::Index columns, Eigen::Index rows) {
  Numbers array = numbers(values, name);
  if (array.ndim() == 1 && array.shape(0) == columns && rows <= 1 && columns > 1) array = reshaped(array, {1, columns});
  const bool fits = array.ndim() == 2 && array.shape(1) == columns && (rows < 0 || array.shape(0) == rows);
  if (!fits)
    throw InputError(fmt::format("{}: expected an array of shape ({}, {}), found {}", name,
                                 rows < 0 ? "n" : fmt::to_string(rows), columns, shape_of(array)));
  if (array.shape(0) == 0) throw InputError(fmt::format("{}: the array is empty", name));
  return array;
}

std::vector<double> list_of_numbers(const py::handle& values, const std::string& name, Eigen::Index rows) {
  const Numbers array = numbers(values, name);
  if (array.ndim() != 1 || (rows >= 0 && array.shape(0) != rows))
    throw InputError(fmt::format("{}: expected an array of shape ({},), found {}", name,
                                 rows < 0 ? "n" : fmt::to_string(rows), shape_of(array)));
  return {array.data(), array.data() + array.size()};
}

std::vector<std::optional<Pose>> poses(const py::handle& values, const std::string& name, Eigen::Index rows) {
  constexpr double orthogonal = 1e-6;
  Numbers array = numbers(values, name);
  if (array.ndim() == 2 && rows <= 1) array = reshaped(array, {1, array.shape(0), array.shape(1)});
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4 || (rows >= 0 && array.shape(0) != rows))
    throw InputError(fmt::format("{}: expected an array of shape ({}, 4, 4), found {}", name,
                                 rows < 0 ? "n" : fmt::to_string(rows), shape_of(array)));
  std::vector<std::optional<Pose>> list(array.shape(0));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(array.data() + 16 * i);
    if (matrix.topRows<3>().array().isNaN().all()) continue;
    const Pose pose{matrix.topLeftCorner<3, 3>(), matrix.topRightCorner<3, 1>()};
    const double error = (pose.rotation.transpose() * pose.rotation - Mat3::Identity()).cwiseAbs().maxCoeff();
    if (!(error < orthogonal) || !(pose.rotation.determinant() > 0.0) || !pose.position.allFinite())
      throw InputError(fmt::format("{}: row {} (from 0) is not a homogeneous matrix [R p; 0 1]", name, i));
    list[i] = pose;
  }
  return list;
}

Numbers joint_positions(const py::handle& values, const Chain& chain, const std::string& name) {
  Numbers array = table(joint_columns(values, chain), name, dof(chain));
  for (py::ssize_t i = 0; i < array.size(); ++i)
    if (!std::isfinite(array.data()[i]))
      throw InputError(fmt::format("{}: row {} (from 0) has a number that is not finite", name, i / dof(chain)));
  if (seem_degrees(array, chain))
    throw InputError(fmt::format("{}: the angles seem to be in degrees; expected radians (numpy.radians)", name));
  return array;
}

py::array matrix_of(const Pose& pose) {
  py::array_t<double> matrix({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> target(matrix.mutable_data());
  target.setIdentity();
  target.topLeftCorner<3, 3>() = pose.rotation;
  target.topRightCorner<3, 1>() = pose.position;
  return matrix;
}

py::array array_of(const MatrixXd& values) {
  py::array_t<double> array({values.rows(), values.cols()});
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      array.mutable_data(), values.rows(), values.cols()) = values;
  return array;
}

}  // namespace kinfer::python
