// SPDX-License-Identifier: Apache-2.0
// Arrays of Python as numbers with a shape that was checked, and errors as Python's.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <span>
#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/linalg/types.hpp"

namespace kinfer::python {

namespace py = pybind11;

/// InputError in Python, a ValueError: one sentence that the user can act on.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value, or its error as InputError.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw InputError(result.error().what);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

/// Numbers in C order; an array that has it already is not copied.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Anything that numpy makes an array of numbers of: arrays, lists, DataFrames. Errors name the argument.
Numbers numbers(const py::handle& values, const std::string& name);

/// The same with the shape (n, columns), or (columns) as one row; `rows`: expected n, −1: any, but at least one.
Numbers table(const py::handle& values, const std::string& name, Eigen::Index columns, Eigen::Index rows = -1);

/// (n) numbers.
std::vector<double> list_of_numbers(const py::handle& values, const std::string& name, Eigen::Index rows = -1);

/// (n, 4, 4) homogeneous matrices, or one. Rows of NaN are none.
std::vector<std::optional<Pose>> poses(const py::handle& values, const std::string& name, Eigen::Index rows = -1);

/// Joint positions (n, dof), or (dof) as one row [rad] or [m], of the chain's active joints; of a DataFrame the columns
/// named as the joints, or q1, q2, …, where it has all. Errors: wrong shape, not finite, angles that are in degrees.
Numbers joint_positions(const py::handle& values, const Chain& chain, const std::string& name = "joints");

/// dof x n, without a copy.
inline Eigen::Map<const MatrixXd> as_columns(const Numbers& values) {
  return {values.data(), values.shape(1), values.shape(0)};
}

/// A 4 x 4 array.
py::array matrix_of(const Pose& pose);

/// A copy as an array.
py::array array_of(const MatrixXd& values);

}  // namespace kinfer::python
