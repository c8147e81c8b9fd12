// SPDX-License-Identifier: Apache-2.0
// kinfer calibrate: nominal robot + outside measurements -> corrected robot + evidence.
#include "kinfer/calibrate/calibrate.hpp"

#include <fmt/ranges.h>

#include <charconv>
#include <memory>

#include "kinfer/calibrate/start/local_poe.hpp"
#include "kinfer/cli/options/pairing_option.hpp"
#include "kinfer/cli/options/search_options.hpp"
#include "kinfer/cli/parts/calibration_summary.hpp"
#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/expected_cost.hpp"
#include "kinfer/cli/parts/model_patch_output.hpp"
#include "kinfer/cli/parts/run_record.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/sweep/task_context.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/files/calibration_files.hpp"
#include "kinfer/io/evidence/fingerprints.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/parameter_names_toml.hpp"
#include "kinfer/measurement/merge_pose_sets.hpp"
#include "kinfer/words/calibration/checks.hpp"
#include "kinfer/words/findings/outliers.hpp"

namespace kinfer::cli {
namespace {

struct CalibrateArguments {
  CommonOptions common;
  SearchArguments search;
  RobotOption robot;
  PairingOption pairing;
  std::string data, out, columns, holdout, parameters = "auto", model = "auto", refit, offsets = "folded";
};

/// Contents of the input files.
struct Inputs {
  RobotModel robot;
  std::optional<PairedFiles> paired{};  ///< where a joint log and a tracker's file were given
  calibrate::CalibrationTask task;
  calibrate::CalibrationOptions options;
};

constexpr std::string_view unknown_prefix = "unknown:";

bool has_no_data_sheet(const RobotOption& robot) {
  return robot.path.starts_with(unknown_prefix);
}

/// The joint types of `unknown:6R`; empty for a robot file.
Result<std::vector<JointType>> read_joint_types(const RobotOption& option) {
  if (!has_no_data_sheet(option)) return std::vector<JointType>{};
  return calibrate::parse_joint_types(option.path.substr(unknown_prefix.size()));
}

/// The robot file; for `unknown:6R` a generic chain, which is sufficient to read the data.
Result<RobotModel> read_robot_or_types(const RobotOption& option, const std::vector<JointType>& types) {
  if (types.empty()) return read_robot(option);
  RobotModel robot;
  robot.chain = calibrate::make_serial_chain(types);
  return robot;
}

Result<calibrate::ParameterChoice> read_parameter_choice(const CalibrateArguments& options) {
  if (options.refit == "offsets") return calibrate::JointOffsetParameters{};
  if (options.parameters == "auto") return calibrate::GeometricParameters{};
  if (options.parameters == "paper24") return calibrate::PaperDhParameters{};
  KINFER_TRY(names, read_parameter_names(options.parameters));
  return calibrate::NamedParameters{names};
}

/// Either a pose set, or a joint log and a tracker's file.
Result<void> check_data(const CalibrateArguments& options, const CLI::App& verb) {
  const bool is_paired = !options.pairing.joints.empty() || !options.pairing.measured.empty();
  if (options.data.empty() && (options.pairing.joints.empty() || options.pairing.measured.empty()))
    return error("expected --data POSES.csv, or --joints and --measured, which are matched as by kinfer pair");
  if (!options.data.empty() && is_paired)
    return error("--data and --joints with --measured are two ways to say the same; give one");
  if (options.data.empty()) return {};
  const auto given = given_pairing_options(verb, options.pairing);
  if (!given.empty()) return error("{} has no effect with --data, whose rows are matched already", given.front().first);
  return {};
}

/// Refuses options that would have no effect.
Result<void> check_arguments(const CalibrateArguments& options, const CLI::App& verb) {
  if (auto effective = check_search_arguments(options.search, verb); !effective) return effective;
  if (auto effective = check_data(options, verb); !effective) return effective;
  const bool refit = !options.refit.empty();
  if (refit && options.search.warm_start.empty())
    return error("--refit offsets: expected --warm-start DIR, the folder of the robot's earlier calibration");
  if (refit && was_given(verb, "--parameters"))
    return error("--parameters has no effect with --refit offsets, which chooses the parameters itself");
  if (!was_given(verb, "--model")) return {};
  if (refit) return error("--model has no effect with --refit offsets: only joint offsets, base and tool are free");
  if (options.search.method != "lm")
    return error("--model has no effect with --method {}: a swarm search has no model selection",
                 options.search.method);
  if (options.parameters != "auto")
    return error("--model has no effect with --parameters {}: model terms need the complete geometric set",
                 options.parameters);
  return {};
}

/// A number is a fraction; anything else is a pose set whose rows are held out and appended to `data`.
Result<calibrate::HoldoutChoice> add_holdout(const std::string& text, const RobotModel& robot, const ColumnMap& map,
                                             PoseSet& data) {
  if (text.empty()) return calibrate::CrossValidation{};
  double fraction = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), fraction);
  if (code == std::errc{} && end == text.data() + text.size()) {
    if (!(fraction > 0.0 && fraction < 1.0))
      return error("--holdout {}: expected a fraction between 0 and 1, or a file", text);
    return calibrate::HeldOutFraction{fraction};
  }
  KINFER_TRY(kept_aside, read_pose_set(text, robot.chain, map));
  data = merge_pose_sets(data, kept_aside);
  return calibrate::HeldOutByLabel{};
}

Result<Inputs> read_inputs(const CalibrateArguments& options) {
  KINFER_TRY(types, read_joint_types(options.robot));
  KINFER_TRY(robot, read_robot_or_types(options.robot, types));
  KINFER_TRY(map, read_columns_option(options.columns));
  std::optional<PairedFiles> paired;
  PoseSet data;
  if (options.data.empty()) {
    KINFER_TRY(found, read_paired(options.pairing, options.columns, robot.chain, types.empty()));
    data = found.set;
    paired = std::move(found);
  } else {
    KINFER_TRY(read, read_pose_set(options.data, robot.chain, map));
    data = std::move(read);
  }
  if (auto possible = check_cost(cost_of_calibration(static_cast<double>(data.rows()), dof(robot.chain))); !possible)
    return forward_error(possible.error());
  KINFER_TRY(parameters, read_parameter_choice(options));
  KINFER_TRY(holdout, add_holdout(options.holdout, robot, map, data));
  KINFER_TRY(model, calibrate::parse_model_choice(options.model));
  KINFER_TRY(swarm_search, read_swarm_options(options.search));
  Inputs inputs{.robot = robot, .paired = std::move(paired), .task = {.nominal = robot.chain}, .options = {}};
  inputs.task.tolerances = robot.tolerances;
  inputs.task.instrument = robot.instrument;
  inputs.task.data = std::move(data);
  inputs.task.joint_types = types;
  inputs.options = {.parameters = parameters,
                    .holdout = holdout,
                    .model = model,
                    .swarm_search = swarm_search,
                    .threads = options.common.threads};
  if (auto done = read_earlier_calibrations(options.search, inputs.task); !done) return forward_error(done.error());
  return inputs;
}

/// Keys of [instrument] that concern no measurement. Instruments that measure orientations, too, may measure points.
std::vector<std::string_view> unused_accuracies(const Instrument& instrument, const PoseSet& data) {
  const auto concerns_any = [&](auto concerns) {
    bool any = false;
    for_each_list(data, [&]<class M>(const std::vector<M>& list) { any |= !list.empty() && concerns(M::traits); });
    return any;
  };
  std::vector<std::string_view> keys;
  for (const InstrumentSigma& sigma : instrument_sigmas)
    if (instrument.*sigma.value && !concerns_any([&](const MeasurementTraits& t) { return t.sigma == sigma.value; }))
      keys.push_back(sigma.key);
  const auto is_angle = [](const MeasurementTraits& t) { return t.default_sigma == &Instrument::sigma_angle; };
  if (instrument.sigma_angle > 0.0 && !instrument.states_lengths() && !concerns_any(is_angle))
    keys.push_back("sigma_angle");
  return keys;
}

void print_notices(const calibrate::CalibrationTask& task) {
  if (!task.instrument) return;
  const std::vector<std::string_view> unused = unused_accuracies(*task.instrument, task.data);
  if (!unused.empty()) print_message("kinfer: {}\n", words::unused_accuracies(unused));
}

bool is_parameter_file(const std::string& parameters) {
  return parameters != "auto" && parameters != "paper24";
}

bool is_holdout_file(const Inputs& inputs) {
  return std::holds_alternative<calibrate::HeldOutByLabel>(inputs.options.holdout);
}

std::vector<std::string> input_paths(const CalibrateArguments& options, const Inputs& inputs) {
  std::vector<std::string> paths;
  if (!has_no_data_sheet(options.robot)) paths.push_back(options.robot.path);
  if (options.data.empty())
    paths.insert(paths.end(), {options.pairing.joints, options.pairing.measured});
  else
    paths.push_back(options.data);
  if (!options.pairing.measured_columns.empty()) paths.push_back(options.pairing.measured_columns);
  if (!options.columns.empty()) paths.push_back(options.columns);
  if (is_parameter_file(options.parameters)) paths.push_back(options.parameters);
  if (is_holdout_file(inputs)) paths.push_back(options.holdout);
  for (const std::string& path : input_paths(options.search)) paths.push_back(path);
  return paths;
}

/// The options that were used, and the names of the files that stand for some of them.
Provenance provenance_of(const CalibrateArguments& options, const Inputs& inputs, const CLI::App& verb) {
  Provenance provenance;
  provenance.seed = options.common.seed;
  provenance.inputs = fingerprints(input_paths(options, inputs));
  provenance.options = calibrate::describe(inputs.task, inputs.options);
  const auto add_file = [&](const char* option, const std::string& path) {
    if (!path.empty()) provenance.options.emplace_back(option, std::filesystem::path(path).filename().string());
  };
  if (options.offsets != "folded") provenance.options.emplace_back("--offsets", options.offsets);
  if (is_holdout_file(inputs)) add_file("--holdout", options.holdout);
  add_file("--columns", options.columns);
  for (const auto& given : given_pairing_options(verb, options.pairing)) provenance.options.push_back(given);
  add_file("--warm-start", options.search.warm_start);
  for (const std::string& path : options.search.prior) add_file("--prior", path);
  for (const auto& [option, value] :
       {std::pair{"--base-link", options.robot.base_link}, std::pair{"--tip-link", options.robot.tip_link}})
    if (!value.empty()) provenance.options.emplace_back(option, value);
  return provenance;
}

Result<void> write_results(OutputFolder& folder, const Provenance& provenance, const Inputs& inputs,
                           const Calibration& calibration) {
  if (inputs.paired)
    if (auto done = write_text_file(folder / "poses.csv",
                                    format_pose_set_csv(inputs.paired->set, inputs.robot.chain, FileUnits::mm_deg));
        !done)
      return done;
  for (const OutputFile& file : calibration_files(calibration, inputs.robot))
    if (auto done = write_text_file(folder / file.name, file.text); !done) return done;
  return write_evidence(folder, calibration_evidence(calibration, provenance));
}

int run(const CalibrateArguments& options, const CLI::App& verb) {
  if (auto effective = check_arguments(options, verb); !effective) return fail(effective.error());
  RunRecord record("calibrate", options.common);
  const auto inputs = read_inputs(options);
  if (!inputs) return fail(inputs.error());
  if (auto effective = check_offsets(was_given(verb, "--offsets"), inputs->robot); !effective)
    return fail(effective.error());
  for (const std::string& path : input_paths(options, *inputs)) record.add_input(path);
  auto folder = record.open_folder(options.out);
  if (!folder) return fail(folder.error());
  const Result<Calibration> calibration = [&] {
    ProgressLine progress(options.common);
    return calibrate::calibrate_robot(inputs->task, inputs->options, Rng(options.common.seed), progress.observer());
  }();
  if (!calibration) return fail(calibration.error());
  if (!options.common.quiet) print_notices(inputs->task);
  if (auto done = write_results(*folder, provenance_of(options, *inputs, verb), *inputs, *calibration); !done)
    return fail(done.error());
  const auto offsets = options.offsets == "separate" ? EncoderOffsets::separate : EncoderOffsets::folded;
  const auto patch = write_model_patch(*folder, inputs->robot, *calibration, offsets);
  if (auto done = record.write(*folder); !done) return fail(done.error());
  if (auto done = write_task_summary(*calibration); !done) return fail(done.error());
  if (auto done = folder->commit(); !done) return fail(done.error());
  const bool usable = calibration->usability != Usability::do_not_use;
  if (options.common.json)
    print_data(format_calibration_headline(*calibration));
  else if (!options.common.quiet)
    print_summary((inputs->paired ? pairing_summary(options.pairing, *inputs->paired) : "") +
                      calibration_summary(*calibration) + (patch ? model_patch_summary(*patch) : ""),
                  usable ? Tone::good : Tone::bad);
  return usable ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_calibrate(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "calibrate", "Correct a robot's model from outside measurements, and prove the gain",
                  "No initial guess of base and tool is needed.\nExample:\n"
                  "  kinfer calibrate --robot robot.toml --data poses.csv --out calibration\n"
                  "  kinfer calibrate --robot robot.toml --joints joints.csv --measured tracker.tsv --out calibration\n"
                  "  kinfer predict --chain calibration/chain.toml --joints joints.csv -o predicted.csv");
  auto options = std::make_shared<CalibrateArguments>();
  add_robot_option(*verb, options->robot, "--robot",
                   "Nominal model: " + readable_model_formats() + "; or unknown:6R, unknown:RRPR: joint types alone");
  add_text(*verb, "--out", options->out, "Folder for chain.toml, chain.urdf, evidence.json, report.html, run.json",
           Requirement::required, "DIR");
  begin_group(*verb, "Data");
  add_text(*verb, "--data", options->data,
           "Pose set: joint positions and measurements (" + words::measured_kinds() + ")", Requirement::optional,
           "CSV");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  begin_group(*verb, "Joint log and tracker, in place of --data");
  add_pairing_options(*verb, options->pairing, Requirement::optional);
  begin_group(*verb, "Model");
  add_text(*verb, "--parameters", options->parameters,
           "auto: the complete geometric set; paper24: a alpha d theta of each joint (base and tool as given, or from "
           "the data where those disagree); or a TOML file "
           "with parameters = [\"a2\", ...]");
  add_text(
      *verb, "--model", options->model,
      fmt::format("auto: geometry and what cross-validation shows to help beyond it; geometry; or some of {} joined "
                  "by +",
                  fmt::join(term_names(), ", ")));
  add_choice(
      *verb, "--refit", options->refit, {"offsets"},
      "offsets: after a knock or a motor change, with few poses: only joint offsets, base and tool are found anew; "
      "all else stays as the earlier calibration (--warm-start) found it");
  add_choice(
      *verb, "--offsets", options->offsets, {"folded", "separate"},
      "Encoder offsets in the URDF or MJCF file that is written back: folded into the origins, for joint positions as "
      "the controller reports them; or separate, for a controller whose zeros are corrected");
  begin_group(*verb, "Validation");
  add_text(*verb, "--holdout", options->holdout,
           "Rows that are never fitted: a fraction (0.2), or a further pose set (default: 5-fold cross-validation)");
  begin_group(*verb, "Search and prior knowledge");
  add_search_arguments(*verb, options->search);
  add_common_options(*verb, options->common);
  return {verb, [options, verb] { return run(*options, *verb); }};
}

}  // namespace kinfer::cli
