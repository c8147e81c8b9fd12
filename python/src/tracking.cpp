// SPDX-License-Identifier: Apache-2.0
// kinfer.track and kinfer.Tracker
#include <cmath>

#include "background.hpp"
#include "kinfer/io/evidence/chain_recordings.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/evidence/track_json.hpp"
#include "kinfer/io/recording/log_rows.hpp"
#include "kinfer/io/recording/possible_times.hpp"
#include "kinfer/io/tracking/track_rows.hpp"
#include "kinfer/io/tracking/tracked_chain.hpp"
#include "kinfer/report/report.hpp"
#include "kinfer/track/rows/row_feed.hpp"
#include "kinfer/track/run_recorder.hpp"
#include "kinfer/track/smooth/smoother.hpp"
#include "kinfer/track/tracker.hpp"
#include "recording.hpp"

namespace kinfer::python {
namespace {

track::TrackOptions options_of(const TrackingModel& model, const py::object& start, const std::string& base) {
  track::TrackOptions options;
  if (base != "auto" && base != "still" && base != "moving")
    throw InputError(fmt::format("base: \"{}\": expected auto, still or moving", base));
  options.base = base == "still"    ? track::BaseMotion::still
                 : base == "moving" ? track::BaseMotion::moving
                                    : track::BaseMotion::automatic;
  if (start.is_none()) return options;
  const std::vector<double> values = list_of_numbers(start, "start", model.positions());
  options.start = Eigen::Map<const VectorXd>(values.data(), model.positions());
  return options;
}

/// Rows of numbers as they come.
struct Columns {
  py::ssize_t width = 0;
  std::vector<double> values{};

  template <class Row>
  void append(const Row& row) {
    values.insert(values.end(), row.data(), row.data() + row.size());
  }
  py::array array() const {
    const auto rows = width > 0 ? static_cast<py::ssize_t>(values.size()) / width : 0;
    return py::array_t<double>({rows, width}, values.data());
  }
};

Eigen::Matrix<double, 6, 1> tool_sd_of(const TrackState& state) {
  Eigen::Matrix<double, 6, 1> sd;
  sd << state.sd_tool_position, state.sd_tool_rotation;
  return sd;
}

/// Row by row, as numpy has it.
Eigen::Matrix<double, 4, 4, Eigen::RowMajor> homogeneous(const Pose& pose) {
  Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = pose.rotation;
  m.topRightCorner<3, 1>() = pose.position;
  return m;
}

Eigen::Vector4d base_of(const TrackState& state) {
  const Quat& q = state.world_q_base;
  return {q.w(), q.x(), q.y(), q.z()};
}

/// kinfer.TrackedRun
struct TrackedRun {
  std::vector<std::string> joints;
  std::vector<double> time{};
  Columns q, qd, sd_q, sd_qd;
  Columns tool{.width = 16}, tool_sd{.width = 6}, base{.width = 4};
  std::string csv{};
  TrackRun run{};
};

/// Keeps all that is asked for later, and stops where the observer throws.
class RunKeeper {
 public:
  explicit RunKeeper(const TrackingModel& model) : writer_(model), recorder_(model) {
    run_.joints = position_names(model);
    const py::ssize_t n = model.positions();
    run_.q.width = run_.qd.width = run_.sd_q.width = run_.sd_qd.width = n;
    run_.csv = writer_.header();
  }

  void add(const TrackState& state) {
    recorder_.add(state);
    writer_.append_csv(state, run_.csv);
    run_.time.push_back(state.time);
    run_.q.append(state.q), run_.qd.append(state.qd);
    run_.sd_q.append(state.sd_q), run_.sd_qd.append(state.sd_qd);
    run_.tool.append(homogeneous(state.base_T_tool));
    run_.tool_sd.append(tool_sd_of(state));
    run_.base.append(base_of(state));
  }

  TrackedRun finish(const std::vector<std::string>& remarks, const Provenance& provenance) {
    TrackRun run = recorder_.run();
    run.remarks = remarks;
    run_.run = track_evidence(run, provenance);
    return std::move(run_);
  }

 private:
  TrackRowWriter writer_;
  track::RunRecorder recorder_;
  TrackedRun run_{};
};

/// Where the rows come from: logs, read as the program reads them, or what Python holds.
struct RowInput {
  std::vector<std::string> paths{};
  InsRecording recording{};

  Result<std::vector<std::string>> each(const TrackingModel& model, const InsRowSink& sink) const {
    std::vector<std::string> sensors;
    for (const TrackingSensor& sensor : model.sensors) sensors.push_back(sensor.name);
    if (!paths.empty()) return each_log_row(paths, sensors, sink);
    if (auto seconds = expect_seconds(recording); !seconds) return forward_error(seconds.error());
    if (auto done = each_row_of(recording, sensors, sink); !done) return forward_error(done.error());
    return recording.remarks;
  }
};

Result<TrackedRun> track_rows(const TrackedMachine& machine, const RowInput& input, const track::TrackOptions& options,
                              track::Estimator estimator, const Provenance& provenance, const Observer& observer) {
  RunKeeper keeper(machine.model);
  const bool smooths = estimator == track::Estimator::smoother;
  std::vector<InsRow> kept;
  track::Tracker tracker(machine.model, options);
  std::size_t rows = 0;
  const auto add = [&](const InsRow& row) -> Result<void> {
    if (++rows % 1000 == 0 && observer) observer({.stage = smooths ? "reading" : "tracking"});
    if (smooths) {
      kept.push_back(row);
      return {};
    }
    tracker.add(row);
    keeper.add(tracker.state());
    return {};
  };
  track::RowFeed feed(machine.model, 0.0);
  KINFER_TRY(remarks, input.each(machine.model, [&](const InsRow& row) { return feed.add(row, add); }));
  if (auto done = feed.finish(add); !done) return forward_error(done.error());
  const auto keep = [&](const TrackState& state) { keeper.add(state); };
  if (smooths) track::smooth(machine.model, options, kept, keep, observer);
  return keeper.finish(remarks, provenance);
}

TrackedRun track_in_python(const py::object& machine, const py::object& data, const py::object& start,
                           const std::string& base, bool smooth, const py::object& progress) {
  const TrackedMachine tracked = tracked_machine(machine);
  const track::TrackOptions options = options_of(tracked.model, start, base);
  const track::Estimator estimator = smooth ? track::Estimator::smoother : track::Estimator::filter;
  RowInput input;
  if (const auto paths = log_paths(data))
    input.paths = *paths;
  else
    input.recording = recording_of(data).recording;
  std::vector<std::string> files = tracked.paths;
  files.insert(files.end(), input.paths.begin(), input.paths.end());
  const Provenance provenance{.inputs = fingerprints(files),
                              .options = track::describe(options, estimator, tracked.model)};
  std::optional<Result<TrackedRun>> result;
  Background(progress).run(
      [&](const Observer& observer) { result = track_rows(tracked, input, options, estimator, provenance, observer); });
  return value_of(std::move(*result));
}

py::object name_or_none(const std::string& name) {
  return name.empty() ? py::object(py::none()) : py::object(py::str(name));
}

py::list events_of(const TrackedRun& run) {
  using namespace py::literals;
  py::list list;
  for (const TrackEvent& event : run.run.events) {
    const auto s = static_cast<std::size_t>(event.alarm.sensor), j = static_cast<std::size_t>(event.alarm.joint);
    const auto size_of_turn = [&](double SensorTurn::*size) {
      return event.alarm.turn ? py::object(py::float_((*event.alarm.turn).*size)) : py::object(py::none());
    };
    list.append(py::dict("kind"_a = std::string(name(event.alarm.kind)),
                         "sensor"_a = name_or_none(event.alarm.sensor < 0 ? "" : run.run.sensors[s].name),
                         "joint"_a = name_or_none(event.alarm.joint < 0 ? "" : run.run.joints[j].name),
                         "since"_a = event.alarm.since, "until"_a = event.until, "sentence"_a = event.sentence,
                         "turn"_a = size_of_turn(&SensorTurn::angle), "turn_sd"_a = size_of_turn(&SensorTurn::sd),
                         "turn_hidden_sd"_a = size_of_turn(&SensorTurn::hidden_sd)));
  }
  return list;
}

void save_run(const TrackedRun& run, const py::object& folder) {
  write_files(path_of(folder).value_or(""), {{"track.csv", run.csv},
                                             {"evidence.json", format_track_run(run.run)},
                                             {"report.html", report::report_html(run.run)}});
}

/// kinfer.Tracker
class LiveTracker {
 public:
  LiveTracker(const py::object& machine, const py::object& start, const std::string& base)
      : model_(tracked_machine(machine).model), tracker_(model_, options_of(model_, start, base)) {
    row_.sensors.resize(model_.sensors.size());
  }

  void add(double time, const py::object& forces, const py::object& rates) {
    const auto sensors = static_cast<Eigen::Index>(model_.sensors.size());
    const Numbers acceleration = table(forces, "acc", 3, sensors), rate = table(rates, "gyr", 3, sensors);
    if (!std::isfinite(time)) throw InputError("t: expected a time [s]");
    if (has_rows_ && time < row_.time)
      throw InputError(fmt::format("t: {} is before {}, the time of the row before", time, row_.time));
    has_rows_ = true;
    row_.time = time;
    for (Eigen::Index s = 0; s < sensors; ++s) {
      InsSample& sample = row_.sensors[static_cast<std::size_t>(s)];
      sample = {.time = time,
                .acceleration = Vec3(acceleration.data() + 3 * s),
                .angular_velocity = Vec3(rate.data() + 3 * s)};
      sample.has_acceleration = sample.acceleration.allFinite();
      sample.has_angular_velocity = sample.angular_velocity.allFinite();
    }
    tracker_.add(row_);
  }

  const TrackState& state() const { return tracker_.state(); }
  const TrackingModel& model() const { return model_; }

  std::vector<std::string> sensors() const {
    std::vector<std::string> names;
    for (const TrackingSensor& sensor : model_.sensors) names.push_back(sensor.name);
    return names;
  }

  std::vector<std::string> alarms() const {
    std::vector<std::string> list;
    for (const TrackAlarm& alarm : state().alarms) {
      std::string text(name(alarm.kind));
      if (alarm.sensor >= 0) text += " " + model_.sensors[static_cast<std::size_t>(alarm.sensor)].name;
      if (alarm.joint >= 0) text += " " + model_.joints[static_cast<std::size_t>(alarm.joint)].name;
      list.push_back(text);
    }
    return list;
  }

 private:
  TrackingModel model_;
  track::Tracker tracker_;
  InsRow row_;
  bool has_rows_ = false;
};

py::array list_array(const VectorXd& values) {
  return py::array_t<double>(values.size(), values.data());
}

void add_run(py::module_& module) {
  py::class_<TrackedRun>(module, "TrackedRun", "A machine at work, row by row.")
      .def_property_readonly(
          "use", [](const TrackedRun& r) { return r.run.verdict.usability != Usability::do_not_use; },
          "False: do not use it")
      .def_property_readonly("usability",
                             [](const TrackedRun& r) { return std::string(name(r.run.verdict.usability)); })
      .def_property_readonly("verdict", [](const TrackedRun& r) { return r.run.verdict.sentence; })
      .def_property_readonly("joint_names", [](const TrackedRun& r) { return r.joints; })
      .def_property_readonly(
          "time",
          [](const TrackedRun& r) {
            return py::array_t<double>(static_cast<py::ssize_t>(r.time.size()), r.time.data());
          },
          "(n,) [s]")
      .def_property_readonly(
          "q", [](const TrackedRun& r) { return r.q.array(); }, "(n, dof) joint positions [rad] or [m]; NaN: unknown")
      .def_property_readonly(
          "qd", [](const TrackedRun& r) { return r.qd.array(); }, "(n, dof) joint velocities, per second")
      .def_property_readonly(
          "sd_q", [](const TrackedRun& r) { return r.sd_q.array(); }, "(n, dof) standard deviations of q")
      .def_property_readonly(
          "sd_qd", [](const TrackedRun& r) { return r.sd_qd.array(); }, "(n, dof) standard deviations of qd")
      .def_property_readonly(
          "tool", [](const TrackedRun& r) { return r.tool.array().attr("reshape")(-1, 4, 4); },
          "(n, 4, 4) pose of the tool in the frame of the base's sensor [m]")
      .def_property_readonly(
          "sd_tool", [](const TrackedRun& r) { return r.tool_sd.array(); },
          "(n, 6) standard deviations: position [m], rotation [rad] about the base sensor's axes")
      .def_property_readonly(
          "base", [](const TrackedRun& r) { return r.base.array(); },
          "(n, 4) quaternions w, x, y, z from the base's sensor to the world (z up, heading 0 at the start)")
      .def_property_readonly("alarms", &events_of, "[{kind, sensor, joint, since [s], until [s], sentence}]")
      .def_property_readonly(
          "evidence_json", [](const TrackedRun& r) { return format_track_run(r.run); },
          "evidence.json, as the program writes it")
      .def("save", &save_run, py::arg("folder"), "Writes the files that the program writes.");
}

void add_live(py::module_& module) {
  py::class_<LiveTracker>(module, "Tracker", "Follows a machine while it works, one row of samples at a time.")
      .def(py::init<const py::object&, const py::object&, const std::string&>(), py::arg("machine"), py::kw_only(),
           py::arg("start") = py::none(), py::arg("base") = "auto",
           "machine: an Identification, or the folder that it was saved in; start: (dof,) joint positions where "
           "tracking begins, NaN: unknown; base: auto, still or moving.")
      .def("add", &LiveTracker::add, py::arg("t"), py::arg("acc"), py::arg("gyr"),
           "The next row: time [s], acc (s, 3) [m/s^2], gyr (s, 3) [rad/s] of the sensors in their order; NaN: no "
           "sample.")
      .def_property_readonly("sensors", &LiveTracker::sensors, "Names, in the order of the rows")
      .def_property_readonly("joint_names", [](const LiveTracker& t) { return position_names(t.model()); })
      .def_property_readonly("started", [](const LiveTracker& t) { return t.state().started; })
      .def_property_readonly("time", [](const LiveTracker& t) { return t.state().time; })
      .def_property_readonly(
          "q", [](const LiveTracker& t) { return list_array(t.state().q); }, "(dof,) [rad] or [m]; NaN: unknown")
      .def_property_readonly("qd", [](const LiveTracker& t) { return list_array(t.state().qd); })
      .def_property_readonly("sd_q", [](const LiveTracker& t) { return list_array(t.state().sd_q); })
      .def_property_readonly(
          "tool", [](const LiveTracker& t) { return matrix_of(t.state().base_T_tool); },
          "(4, 4) in the frame of the base's sensor [m]")
      .def_property_readonly(
          "sd_tool", [](const LiveTracker& t) { return list_array(tool_sd_of(t.state())); },
          "(6,) position [m], rotation [rad]")
      .def_property_readonly("alarms", &LiveTracker::alarms, "Active now: kind and name of the sensor or joint");
}

}  // namespace

TrackedMachine tracked_machine(const py::object& machine) {
  if (py::isinstance<IdentificationResult>(machine)) {
    const auto& [identification, provenance] = machine.cast<const IdentificationResult&>();
    if (!identification.tracking) throw InputError("the identified machine has no tracking data");
    return {*identification.tracking, {}, all_inputs(provenance.inputs, provenance.earlier_inputs)};
  }
  const auto folder = path_of(machine);
  if (!folder) throw InputError("expected an Identification, or the folder that it was saved in");
  return {value_of(read_tracked_chain(*folder, "")).model, ChainFiles(*folder).names(), recordings_of_chain(*folder)};
}

void add_tracking(py::module_& module) {
  add_run(module);
  add_live(module);
  module.def(
      "track", &track_in_python, py::arg("machine"), py::arg("data"), py::kw_only(), py::arg("start") = py::none(),
      py::arg("base") = "auto", py::arg("smooth") = false, py::arg("progress") = py::none(),
      "Joint positions and tool pose of an identified machine at work. machine: an Identification, or the folder "
      "that it was saved in; data: a Recording, the paths of logs, or {sensor: columns} as for identify; start: "
      "(dof,) joint positions where the data begin [rad] or [m], NaN: unknown; base: auto, still or moving; "
      "smooth: use what comes after each row, too.");
}

}  // namespace kinfer::python
