// SPDX-License-Identifier: Apache-2.0
// kinfer.calibrate
#include "kinfer/calibrate/calibrate.hpp"

#include "background.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/files/model_patch_files.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/report/report.hpp"
#include "kinfer/words/calibration/calibration.hpp"
#include "measured_rows.hpp"
#include "robot.hpp"

namespace kinfer::python {
namespace {

struct CalibrationResult {
  Calibration calibration;
  RobotModel robot;
  Provenance provenance;
};

calibrate::ParameterChoice parameter_choice(const py::object& parameters) {
  if (!py::isinstance<py::str>(parameters))
    return calibrate::NamedParameters{parameters.cast<std::vector<std::string>>()};
  const std::string text = py::str(parameters);
  if (text == "auto") return calibrate::GeometricParameters{};
  if (text == "paper24") return calibrate::PaperDhParameters{};
  if (text == "offsets") return calibrate::JointOffsetParameters{};
  throw InputError(fmt::format("parameters: \"{}\": expected \"auto\", \"offsets\", \"paper24\" or names", text));
}

/// Joint positions as an array, a pose set, or the path of one.
Poses pose_set_of(const py::object& joints, const Robot& robot, const MeasuredArguments& given) {
  if (py::isinstance<Poses>(joints)) return joints.cast<Poses>();
  if (const auto path = path_of(joints)) return {value_of(read_pose_set(*path, robot.model.chain)), {*path}};
  return {measured_rows(joints, robot.model.chain, given)};
}

Provenance provenance_of(const Robot& robot, const Poses& poses, const calibrate::CalibrationTask& task,
                         const calibrate::CalibrationOptions& options, std::uint64_t seed) {
  Provenance provenance;
  provenance.seed = seed;
  std::vector<std::string> paths = robot.paths;
  paths.insert(paths.end(), poses.paths.begin(), poses.paths.end());
  provenance.inputs = fingerprints(paths);
  provenance.options = calibrate::describe(task, options);
  provenance.options.insert(provenance.options.end(), poses.options.begin(), poses.options.end());
  for (const auto& [option, value] :
       {std::pair{"--base-link", robot.ends.base_link}, std::pair{"--tip-link", robot.ends.tip_link}})
    if (!value.empty()) provenance.options.emplace_back(option, value);
  return provenance;
}

CalibrationResult calibrate_in_python(const Robot& robot, const py::object& joints, const MeasuredArguments& given,
                                      const py::object& parameters, const std::string& model,
                                      const std::optional<double>& holdout, const Robot* earlier, std::uint64_t seed,
                                      int threads, const py::object& progress) {
  const Poses data = pose_set_of(joints, robot, given);
  calibrate::CalibrationTask task{.nominal = robot.model.chain};
  task.tolerances = robot.model.tolerances;
  task.instrument = instrument_of(given, robot.model);
  task.data = data.set;
  if (earlier) task.earlier = earlier->model.chain;
  calibrate::CalibrationOptions options;
  options.parameters = parameter_choice(parameters);
  options.model = value_of(calibrate::parse_model_choice(model));
  options.threads = threads;
  if (holdout) {
    if (!(*holdout > 0.0 && *holdout < 1.0)) throw InputError("holdout: expected a fraction between 0 and 1");
    options.holdout = calibrate::HeldOutFraction{*holdout};
  }
  std::optional<Result<Calibration>> result;
  Background(progress).run(
      [&](const Observer& observer) { result = calibrate::calibrate_robot(task, options, Rng(seed), observer); });
  return {value_of(std::move(*result)), robot.model, provenance_of(robot, data, task, options, seed)};
}

std::string calibration_text(const CalibrationResult& result) {
  return format_calibration_evidence(calibration_evidence(result.calibration, result.provenance));
}

py::list parameters_of(const CalibrationResult& result) {
  py::list list;
  for (const ParameterEstimate& p : result.calibration.estimate.values) {
    using namespace py::literals;
    list.append(py::dict("name"_a = p.name, "nominal"_a = p.nominal, "value"_a = p.value, "sd"_a = p.sd,
                         "unit"_a = std::string(unit(p.quantity)), "identifiable"_a = p.identifiable));
  }
  return list;
}

Robot corrected_robot(const CalibrationResult& result) {
  Robot robot{result.robot};
  robot.model.chain = corrected_chain(result.calibration);
  robot.model.tolerances = result.calibration.nominal_model.tolerances;
  robot.model.prediction = result.calibration.prediction;
  robot.model.source.reset();
  return robot;
}

void save_calibration(const CalibrationResult& result, const py::object& folder, const std::string& offsets) {
  if (offsets != "folded" && offsets != "separate") throw InputError("offsets: expected \"folded\" or \"separate\"");
  std::vector<std::pair<std::string, std::string>> files;
  for (OutputFile& file : calibration_files(result.calibration, result.robot))
    files.emplace_back(std::move(file.name), std::move(file.text));
  if (result.robot.source) {
    auto patched = value_of(patch_model(result.robot, result.calibration,
                                        offsets == "separate" ? EncoderOffsets::separate : EncoderOffsets::folded));
    for (OutputFile& file : patched.files) files.emplace_back(std::move(file.name), std::move(file.text));
  }
  const CalibrationEvidence evidence = calibration_evidence(result.calibration, result.provenance);
  files.emplace_back("evidence.json", format_calibration_evidence(evidence));
  files.emplace_back("report.html", report::report_html(evidence));
  write_files(path_of(folder).value_or(""), files);
}

constexpr const char* calibrate_doc =
    R"(Correct a robot's model from outside measurements, and prove the gain on rows that were not fitted.

joints: (n, dof) joint positions [rad] or [m], a DataFrame with columns named as the joints or q1, q2, …; or a PoseSet,
or the path of a pose set file, which then holds the measurements.
positions: (n, 3) tool points in the frame of the instrument [m]; a row of NaN was not measured.
poses: (n, 4, 4) tool poses in that frame [m], in place of positions.
distances: (n,) lengths of a draw wire [m]; anchors: (n,) which anchor of the robot file, from 0 (default 0).
sockets: n names; rows with the same name touch the same fixed unknown point.
sd: standard deviation [m]: one number, (n,) or (n, 3); default: estimated from the residuals. sd_angle: of poses [rad].
setup: n names; each has a base and a tool of its own.
parameters: "auto", "offsets" (after a knock; earlier: the calibrated robot), "paper24", or names as "a2".
model: "auto", "geometry" or names of terms joined by "+". holdout: fraction of rows that are never fitted (default:
5-fold cross-validation). progress: called as progress(stage, fraction).

Raises InputError where the data contradict the robot or the options.)";

}  // namespace

void add_calibration(py::module_& module) {
  py::class_<CalibrationResult>(module, "Calibration", "A corrected robot and the evidence for it.")
      .def_property_readonly(
          "use", [](const CalibrationResult& r) { return r.calibration.usability != Usability::do_not_use; },
          "False: do not use it")
      .def_property_readonly(
          "usability", [](const CalibrationResult& r) { return std::string(name(r.calibration.usability)); },
          "\"use\", \"use_with_care\" or \"do_not_use\"")
      .def_property_readonly("verdict", [](const CalibrationResult& r) { return words::verdict(r.calibration); })
      .def_property_readonly("parameters", &parameters_of,
                             "Dictionaries of name, nominal, value, sd, unit, identifiable [SI]")
      .def_property_readonly(
          "covariance", [](const CalibrationResult& r) { return array_of(r.calibration.estimate.covariance); },
          "(p, p) covariance of the parameters, in their order [SI]")
      .def_property_readonly("robot", &corrected_robot, "The corrected robot")
      .def_property_readonly(
          "rms_before",
          [](const CalibrationResult& r) { return reported_errors(r.calibration, r.calibration.before).rms; },
          "Held-out rms error of the nominal model, base and tool refitted [m]")
      .def_property_readonly(
          "rms_after",
          [](const CalibrationResult& r) { return reported_errors(r.calibration, r.calibration.after).rms; },
          "Held-out rms error of the corrected model [m]")
      .def_property_readonly("evidence_json", &calibration_text, "evidence.json, as the program writes it")
      .def_property_readonly(
          "evidence",
          [](const CalibrationResult& r) { return py::module_::import("json").attr("loads")(calibration_text(r)); },
          "evidence.json as a dictionary")
      .def("save", &save_calibration, py::arg("folder"), py::kw_only(), py::arg("offsets") = "folded",
           "Writes the files that the program writes: chain.toml, chain.urdf, evidence.json, report.html, …, and the "
           "robot's own URDF or MJCF file with calibrated origins.");
  module.def(
      "calibrate",
      [](const Robot& robot, const py::object& joints, py::object positions, py::object poses_, py::object distances,
         py::object anchors, py::object sockets, py::object sd, py::object sd_angle, py::object setup,
         const py::object& parameters, const std::string& model, const std::optional<double>& holdout,
         const Robot* earlier, std::uint64_t seed, int threads, const py::object& progress) {
        const MeasuredArguments given{std::move(positions), std::move(poses_), std::move(distances), std::move(anchors),
                                      std::move(sockets),   std::move(sd),     std::move(sd_angle),  std::move(setup)};
        return calibrate_in_python(robot, joints, given, parameters, model, holdout, earlier, seed, threads, progress);
      },
      py::arg("robot"), py::arg("joints"), py::kw_only(), py::arg("positions") = py::none(),
      py::arg("poses") = py::none(), py::arg("distances") = py::none(), py::arg("anchors") = py::none(),
      py::arg("sockets") = py::none(), py::arg("sd") = py::none(), py::arg("sd_angle") = py::none(),
      py::arg("setup") = py::none(), py::arg("parameters") = "auto", py::arg("model") = "auto",
      py::arg("holdout") = py::none(), py::arg("earlier") = py::none(), py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("progress") = py::none(), calibrate_doc);
}

}  // namespace kinfer::python
