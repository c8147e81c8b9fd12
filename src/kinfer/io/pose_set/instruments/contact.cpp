// SPDX-License-Identifier: Apache-2.0
// Columns socket and plane: the name of the fixture that the tool point touches.
#include "kinfer/io/pose_set/measurement_columns.hpp"

namespace kinfer {

template <>
MeasurementColumns measurement_columns<SocketContact>() {
  return {read_fixture_contacts<SocketContact>, write_fixture_names<SocketContact>};
}

template <>
MeasurementColumns measurement_columns<PlaneContact>() {
  return {read_fixture_contacts<PlaneContact>, write_fixture_names<PlaneContact>};
}

}  // namespace kinfer
