// SPDX-License-Identifier: Apache-2.0
// kinfer.read_log, kinfer.identify and kinfer.orient
#include <cmath>

#include "background.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/inertial/sensor_orientations.hpp"
#include "kinfer/io/evidence/chain_recordings.hpp"
#include "kinfer/io/evidence/files/identification_files.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/io/recording/ins_arrays.hpp"
#include "kinfer/io/recording/recording_formats.hpp"
#include "kinfer/report/report.hpp"
#include "kinfer/words/identification/verdict.hpp"
#include "recording.hpp"

namespace kinfer::python {
namespace {

py::object item_or_none(const py::handle& mapping, const std::vector<const char*>& keys) {
  for (const char* key : keys)
    if (mapping.contains(key)) return mapping[key];
  return py::none();
}

/// Three columns of a mapping or DataFrame: one entry "acc" of shape (n, 3), or three as "ax", "ay", "az".
Numbers triad(const py::handle& columns, const std::string& sensor, const char* key, const char* axes, bool& found) {
  const std::string name = fmt::format("{}: {}", sensor, key);
  py::object value = item_or_none(columns, {key});
  found = !value.is_none();
  if (found) return table(value, name, 3);
  py::list three;
  for (const char axis : std::string("xyz")) {
    const std::string column = std::string(axes) + axis;
    if (!columns.contains(column.c_str())) return Numbers();
    three.append(numbers(columns[column.c_str()], name));
  }
  found = true;
  return table(py::module_::import("numpy").attr("column_stack")(three), name, 3);
}

void append_sensor(const std::string& sensor, const py::handle& columns, InsRecording& recording) {
  const py::object time = item_or_none(columns, {"t", "time"});
  if (time.is_none()) throw InputError(fmt::format("{}: expected t, the time of each row [s]", sensor));
  const auto t = list_of_numbers(time, sensor + ": t");
  bool has_acceleration = false, has_rate = false, has_field = false;
  const Numbers acceleration = triad(columns, sensor, "acc", "a", has_acceleration),
                rate = triad(columns, sensor, "gyr", "g", has_rate),
                field = triad(columns, sensor, "mag", "m", has_field);
  if (!has_acceleration || !has_rate)
    throw InputError(fmt::format("{}: expected acc (n, 3) [m/s^2] and gyr (n, 3) [rad/s]", sensor));
  for (const auto& [values, name] :
       {std::pair{&acceleration, "acc"}, std::pair{&rate, "gyr"}, std::pair{&field, "mag"}})
    if (values->size() > 0 && values->shape(0) != static_cast<py::ssize_t>(t.size()))
      throw InputError(fmt::format("{}: {} has {} rows and t has {}", sensor, name, values->shape(0), t.size()));
  const auto span = [](const Numbers& values) {
    return std::span(values.data(), static_cast<std::size_t>(values.size()));
  };
  value_of(append_ins_arrays(
      {sensor, t, span(acceleration), span(rate), has_field ? span(field) : std::span<const double>{}}, recording));
}

py::array columns_of(const TriadColumns& triad) {
  const std::size_t rows = triad.axis[0].size();
  py::array_t<float> array({rows, std::size_t{3}});
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < 3; ++k) array.mutable_at(i, k) = triad.axis[k][i];
  return array;
}

py::dict sensors_of(const Recording& data) {
  using namespace py::literals;
  py::dict sensors;
  for (const InsSensor& sensor : data.recording.sensors) {
    const auto time = data.recording.time(sensor);
    sensors[py::str(sensor.name)] =
        py::dict("t"_a = py::array_t<double>(static_cast<py::ssize_t>(time.size()), time.data()),
                 "acc"_a = columns_of(sensor.acceleration), "gyr"_a = columns_of(sensor.angular_velocity),
                 "mag"_a = sensor.has_magnetometer() ? py::object(columns_of(sensor.field)) : py::none());
  }
  return sensors;
}

IdentificationResult identify_in_python(const py::object& data, const std::optional<std::string>& root,
                                        const std::vector<std::string>& sensors,
                                        const std::vector<std::pair<std::string, std::string>>& tree,
                                        const py::object& update, std::uint64_t seed, int threads,
                                        const py::object& progress) {
  const Recording recording = recording_of(data);
  std::vector<std::string> inputs = recording.paths;
  std::vector<InputFile> earlier;
  identify::IdentifyOptions options;
  options.root = root;
  options.sensors = sensors;
  for (const auto& [one, other] : tree) options.tree.push_back({one, other});
  options.threads = threads;
  if (!update.is_none()) {
    TrackedMachine known = tracked_machine(update);
    options.refine.known = std::move(known.model);
    earlier = std::move(known.recordings);
    value_of(
        expect_new_recordings(recording.paths, recording.recording, earlier, path_of(update).value_or("the machine")));
    inputs.insert(inputs.end(), known.paths.begin(), known.paths.end());
  }
  // The filter of the program's default.
  options.motion.filter = *filter_named("kinfer-offline");
  value_of(identify::check(options));
  auto described = identify::describe(options);
  if (const auto folder = path_of(update)) described.emplace_back("--update", *folder);
  std::optional<Result<Identification>> result;
  Background(progress).run([&](const Observer& observer) {
    result = identify::identify_machine(recording.recording, options, Rng(seed), observer);
  });
  return {value_of(std::move(*result)),
          {.inputs =
               recording.paths.empty() ? fingerprints(inputs) : with_samples(fingerprints(inputs), recording.recording),
           .options = std::move(described),
           .seed = seed,
           .earlier_inputs = std::move(earlier)}};
}

std::string identification_text(const IdentificationResult& result) {
  return format_identification_evidence(identification_evidence(result.identification, result.provenance));
}

py::object identification_dictionary(const IdentificationResult& result) {
  return py::module_::import("json").attr("loads")(identification_text(result));
}

void save_identification(const IdentificationResult& result, const py::object& folder) {
  std::vector<std::pair<std::string, std::string>> files;
  for (OutputFile& file : identification_files(result.identification))
    files.emplace_back(std::move(file.name), std::move(file.text));
  const IdentificationEvidence evidence = identification_evidence(result.identification, result.provenance);
  files.emplace_back("evidence.json", format_identification_evidence(evidence));
  files.emplace_back("report.html", report::report_html(evidence));
  write_files(path_of(folder).value_or(""), files);
}

py::dict orient_in_python(const py::object& data, const std::string& filter, bool magnetometer) {
  const Recording recording = recording_of(data);
  const auto found = filter_named(filter);
  if (!found) throw InputError(fmt::format("filter: \"{}\": expected one of {}", filter, filter_names()));
  const FilterOptions how = magnetometer ? *found : without_magnetometer(*found);
  std::vector<std::size_t> all(recording.recording.sensors.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  std::vector<SensorOrientations> orientations;
  {
    const py::gil_scoped_release without_lock;
    orientations = value_of(estimate_orientations(recording.recording, all, how));
  }
  py::dict result;
  for (const SensorOrientations& sensor : orientations) {
    py::array_t<double> array({sensor.world_q_sensor.size(), std::size_t{4}});
    for (std::size_t i = 0; i < sensor.world_q_sensor.size(); ++i) {
      const Quat& q = sensor.world_q_sensor[i];
      array.mutable_at(i, 0) = q.w(), array.mutable_at(i, 1) = q.x();
      array.mutable_at(i, 2) = q.y(), array.mutable_at(i, 3) = q.z();
    }
    result[py::str(recording.recording.sensors[sensor.sensor].name)] = array;
  }
  return result;
}

}  // namespace

std::optional<std::vector<std::string>> log_paths(const py::object& data) {
  if (const auto path = path_of(data)) return std::vector{*path};
  if (!py::isinstance<py::list>(data) && !py::isinstance<py::tuple>(data)) return std::nullopt;
  std::vector<std::string> paths;
  for (const py::handle item : data) {
    const auto path = path_of(item);
    if (!path) throw InputError("expected the paths of logs");
    paths.push_back(*path);
  }
  if (paths.empty()) return std::nullopt;
  return paths;
}

Recording recording_of(const py::object& data) {
  if (py::isinstance<Recording>(data)) return data.cast<Recording>();
  Recording result;
  if (const auto paths = log_paths(data)) {
    result.paths = *paths;
    const std::vector<std::filesystem::path> files(paths->begin(), paths->end());
    const py::gil_scoped_release without_lock;
    result.recording = value_of(read_recording(files));
    return result;
  }
  if (!py::hasattr(data, "items"))
    throw InputError("expected a recording, the path of a log, or a dictionary {sensor: {t, acc, gyr, mag}}");
  for (const py::handle item : data.attr("items")()) {
    const auto pair = item.cast<std::pair<py::object, py::object>>();
    append_sensor(py::str(pair.first), pair.second, result.recording);
  }
  return result;
}

void add_identification(py::module_& module) {
  py::class_<Recording>(module, "Recording", "A recording of inertial sensors.")
      .def_property_readonly("sensors", &sensors_of,
                             "{sensor: {t (n,) [s], acc (n, 3) [m/s^2], gyr (n, 3) [rad/s], mag (n, 3) [uT] or None}}")
      .def_property_readonly("remarks", [](const Recording& data) { return data.recording.remarks; });
  module.def(
      "read_log", [](const py::object& data) { return recording_of(data); }, py::arg("paths"),
      "Reads a log, or several, one per logger.");
  py::class_<IdentificationResult>(module, "Identification", "The chain of an unknown machine and the evidence for it.")
      .def_property_readonly(
          "use", [](const IdentificationResult& r) { return r.identification.usability != Usability::do_not_use; },
          "False: do not use it")
      .def_property_readonly(
          "usability", [](const IdentificationResult& r) { return std::string(name(r.identification.usability)); })
      .def_property_readonly(
          "verdict", [](const IdentificationResult& r) { return words::identification_verdict(r.identification); })
      .def_property_readonly(
          "joints", [](const IdentificationResult& r) { return py::object(identification_dictionary(r)["joints"]); },
          "The joints as evidence.json has them")
      .def_property_readonly(
          "robot", [](const IdentificationResult& r) { return Robot{RobotModel{.chain = r.identification.chain}}; })
      .def_property_readonly("evidence_json", &identification_text, "evidence.json, as the program writes it")
      .def_property_readonly("evidence", &identification_dictionary, "evidence.json as a dictionary")
      .def("save", &save_identification, py::arg("folder"), "Writes the files that the program writes.");
  module.def(
      "identify", &identify_in_python, py::arg("data"), py::kw_only(), py::arg("root") = py::none(),
      py::arg("sensors") = std::vector<std::string>{},
      py::arg("tree") = std::vector<std::pair<std::string, std::string>>{}, py::arg("update") = py::none(),
      py::arg("seed") = 1, py::arg("threads") = 0, py::arg("progress") = py::none(),
      "Find the chain of an unknown machine from one inertial sensor on each segment. data: a Recording, the path "
      "of a log, or {sensor: columns}, where columns (a dictionary or DataFrame) have t (n,) [s], acc (n, 3) "
      "[m/s^2], gyr (n, 3) [rad/s] and, where there is one, mag (n, 3) [uT]; or ax, ay, az, gx, … each. root: "
      "sensor on the base; sensors: those to use; tree: pairs of sensors whose segments share a joint; update: an "
      "earlier Identification "
      "of this machine, or the folder that it was saved in: its structure is kept, what changed since is in "
      "evidence[\"update\"], and the new chain is that of both logs.");
  module.def(
      "orient", &orient_in_python, py::arg("data"), py::kw_only(), py::arg("filter") = "kinfer-offline",
      py::arg("magnetometer") = true,
      "Orientation of each sensor, {sensor: (n, 4)} quaternions w, x, y, z from the sensor to the world (x east, "
      "y north, z up).");
}

}  // namespace kinfer::python
