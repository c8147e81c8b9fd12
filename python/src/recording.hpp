// SPDX-License-Identifier: Apache-2.0
// Recordings and identified machines as Python holds them.
#pragma once

#include "kinfer/evidence/facts/provenance.hpp"
#include "kinfer/evidence/identification/identification.hpp"
#include "kinfer/measurement/ins/ins_recording.hpp"
#include "robot.hpp"

namespace kinfer::python {

/// kinfer.Recording
struct Recording {
  InsRecording recording;
  std::vector<std::string> paths{};
};

/// kinfer.Identification
struct IdentificationResult {
  Identification identification;
  Provenance provenance;
};

/// What tracking and updates need of a machine, the files that it came from, and the recordings that it was identified
/// from.
struct TrackedMachine {
  TrackingModel model;
  std::vector<std::string> paths{};
  std::vector<InputFile> recordings{};
};

/// Of an Identification, or of the folder that it was saved in.
TrackedMachine tracked_machine(const py::object& machine);

/// The paths, where `data` is a path or a list of them.
std::optional<std::vector<std::string>> log_paths(const py::object& data);

/// A recording, the path or paths of logs, or {sensor: {t, acc, gyr, mag}}.
Recording recording_of(const py::object& data);

}  // namespace kinfer::python
