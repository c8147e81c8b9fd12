// SPDX-License-Identifier: Apache-2.0
// kinfer calibrate: nominal robot + outside measurements -> corrected robot + evidence.
#include "kinfer/calibrate/calibrate.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <sstream>

#include "kinfer/calibrate/start/local_poe.hpp"
#include "kinfer/calibrate/start/unknown_robot.hpp"
#include "kinfer/calibrate/terms/model_terms.hpp"
#include "kinfer/cli/parts/calibration_summary.hpp"
#include "kinfer/cli/parts/calibration_tables.hpp"
#include "kinfer/cli/parts/evidence_files.hpp"
#include "kinfer/cli/parts/robot_option.hpp"
#include "kinfer/cli/parts/search_options.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/parameter_names_toml.hpp"
#include "kinfer/io/robot/urdf.hpp"
#include "kinfer/io/text/text_file.hpp"
#include "kinfer/measurement/merge_pose_sets.hpp"

namespace kinfer::cli {
namespace {

struct CalibrateArguments {
  CommonOptions common;
  SearchArguments search;
  RobotOption robot;
  std::string data, out, columns, holdout, parameters = "auto", model = "auto", refit;
};

/// Contents of the input files.
struct Inputs {
  RobotModel robot;
  PoseSet data;
  calibrate::CalibrationOptions how;
  std::vector<std::string> found;  ///< sentences about a robot identified without a data sheet
};

constexpr std::string_view unknown_prefix = "unknown:";

bool has_no_data_sheet(const RobotOption& robot) {
  return robot.path.starts_with(unknown_prefix);
}

/// The robot file; for `unknown:6R` a generic chain, which is sufficient to read the data.
Result<RobotModel> read_robot_or_types(const RobotOption& option) {
  if (!has_no_data_sheet(option)) return read_robot(option);
  KINFER_TRY(types, calibrate::parse_joint_types(option.path.substr(unknown_prefix.size())));
  RobotModel robot;
  robot.chain = calibrate::make_serial_chain(types);
  return robot;
}

/// Identifies the nominal model of `unknown:6R` from the rows that are not labelled holdout.
Result<void> identify_nominal_robot(const CalibrateArguments& options, Inputs& inputs) {
  std::vector<int> rows;
  for (int row = 0; row < inputs.data.rows(); ++row)
    if (inputs.data.set.empty() || inputs.data.set[row] != SplitLabel::holdout) rows.push_back(row);
  KINFER_TRY(found, calibrate::estimate_unknown_robot(options.robot.path.substr(unknown_prefix.size()),
                                                      select(inputs.data, rows), options.common.threads,
                                                      Rng(options.common.seed).stream(17)));
  inputs.robot.chain = found.nominal;
  inputs.robot.chain.name = "unknown";
  inputs.robot.tolerances = found.tolerances;
  inputs.found = found.words;
  return {};
}

Result<calibrate::ParameterChoice> read_parameter_choice(const std::string& text) {
  if (text == "auto") return calibrate::GeometricParameters{};
  if (text == "paper24") return calibrate::PaperDhParameters{};
  KINFER_TRY(names, read_parameter_names(text));
  return calibrate::NamedParameters{names};
}

/// "auto", "geometry", or model terms joined by "+".
Result<calibrate::ModelChoice> read_model_choice(const std::string& text) {
  if (text == "auto") return calibrate::CrossValidatedModel{};
  calibrate::FixedModel named;
  const std::vector<std::string> known = calibrate::model_term_names();
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, '+');) {
    if (word == "geometry") continue;
    if (std::find(known.begin(), known.end(), word) == known.end())
      return error("--model {}: expected auto, geometry or some of {} joined by +", text, fmt::join(known, ", "));
    named.model_terms.push_back(word);
  }
  return named;
}

/// A number is a fraction; anything else is a pose set whose rows are held out and appended to `data`.
Result<calibrate::HoldoutChoice> add_holdout(const std::string& text, const RobotModel& robot, const ColumnMap& map,
                                             PoseSet& data) {
  if (text.empty()) return calibrate::CrossValidation{};
  double fraction = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), fraction);
  if (code == std::errc{} && end == text.data() + text.size()) {
    if (fraction <= 0.0 || fraction >= 1.0)
      return error("--holdout {}: expected a fraction between 0 and 1, or a file", text);
    return calibrate::HeldOutFraction{fraction};
  }
  KINFER_TRY(kept_aside, read_pose_set(text, robot.chain, map));
  data = merge_pose_sets(data, kept_aside);
  return calibrate::HeldOutByLabel{};
}

Result<Inputs> read_inputs(const CalibrateArguments& options) {
  Inputs inputs;
  KINFER_TRY(robot, read_robot_or_types(options.robot));
  KINFER_TRY(map, read_columns_option(options.columns));
  KINFER_TRY(data, read_pose_set(options.data, robot.chain, map));
  KINFER_TRY(parameters, read_parameter_choice(options.parameters));
  KINFER_TRY(holdout, add_holdout(options.holdout, robot, map, data));
  KINFER_TRY(model, read_model_choice(options.model));
  inputs.how = {.parameters = parameters, .holdout = holdout, .model = model, .threads = options.common.threads};
  KINFER_TRY(swarm_search, population_options(options.search, options.common.threads));
  inputs.how.swarm_search = swarm_search;
  inputs.robot = std::move(robot);
  inputs.data = std::move(data);
  if (has_no_data_sheet(options.robot))
    if (auto done = identify_nominal_robot(options, inputs); !done) return forward_error(done.error());
  return inputs;
}

std::vector<std::string> input_paths(const CalibrateArguments& options) {
  std::vector<std::string> paths{options.data};
  if (!has_no_data_sheet(options.robot)) paths.insert(paths.begin(), options.robot.path);
  for (const std::string& path : {options.columns, options.parameters, options.holdout})
    if (std::filesystem::is_regular_file(path)) paths.push_back(path);
  for (const std::string& path : input_paths(options.search)) paths.push_back(path);
  return paths;
}

Provenance provenance_of(const CalibrateArguments& options) {
  Provenance provenance;
  provenance.seed = options.common.seed;
  provenance.inputs = fingerprints(input_paths(options));
  const auto plain = [](const std::string& value) { return std::filesystem::path(value).filename().string(); };
  provenance.options.emplace_back("--parameters", plain(options.parameters));
  provenance.options.emplace_back("--model", options.model);
  if (!options.refit.empty()) provenance.options.emplace_back("--refit", options.refit);
  if (options.search.method != "lm") provenance.options.emplace_back("--method", options.search.method);
  if (!options.holdout.empty()) provenance.options.emplace_back("--holdout", plain(options.holdout));
  if (!options.search.warm_start.empty())
    provenance.options.emplace_back("--warm-start", plain(options.search.warm_start));
  for (const std::string& path : options.search.prior) provenance.options.emplace_back("--prior", plain(path));
  return provenance;
}

Result<void> write_results(const CalibrateArguments& options, RobotModel robot, const Calibration& calibration) {
  const std::filesystem::path folder(options.out);
  StandardDeviations sd;
  for (const ParameterEstimate& p : calibration.estimate.values) sd[p.name] = p.sd;
  robot.chain = with_small_rotations_folded(calibration.estimate.chain);
  if (auto done = write_text_file(folder / "chain.toml", format_robot_toml(robot, sd)); !done) return done;
  if (auto done = write_text_file(folder / "chain.urdf", format_urdf(robot.chain)); !done) return done;
  if (const std::string& net = calibration.estimate.search.net; !net.empty())
    if (auto done = write_text_file(folder / "net.txt", net); !done) return done;
  return write_evidence(folder, format_calibration_evidence(calibration, provenance_of(options)));
}

/// The earlier calibration becomes the nominal model; with few poses, leave-one-out cross-validation is used.
Result<void> start_from_earlier(calibrate::CalibrationTask& task, calibrate::CalibrationOptions& how) {
  if (!task.earlier)
    return error("--refit offsets: expected --warm-start DIR, the folder of the robot's earlier calibration");
  task.nominal = *task.earlier;
  task.earlier.reset();
  how.parameters = calibrate::JointOffsetParameters{};
  how.model = calibrate::FixedModel{};
  constexpr int few = 12;
  if (auto* folds = std::get_if<calibrate::CrossValidation>(&how.holdout); folds && task.data.rows() <= few)
    folds->folds = static_cast<int>(task.data.rows());
  return {};
}

int run(const CalibrateArguments& options) {
  RunRecord record("calibrate", options.common);
  for (const std::string& path : input_paths(options)) record.add_input(path);
  auto inputs = read_inputs(options);
  if (!inputs) return fail(inputs.error());
  const auto folder = OutputFolder::make(options.out);
  if (!folder) return fail(folder.error());
  calibrate::CalibrationTask task{
      inputs->robot.chain, inputs->robot.tolerances, inputs->robot.instrument, inputs->data, {}, {}, {}};
  if (auto done = read_earlier_calibrations(options.search, task); !done) return fail(done.error());
  if (options.refit == "offsets")
    if (auto done = start_from_earlier(task, inputs->how); !done) return fail(done.error());
  Result<Calibration> calibration = [&] {
    ProgressLine progress(options.common);
    return calibrate::calibrate_robot(task, inputs->how, Rng(options.common.seed), progress.observer());
  }();
  if (!calibration) return fail(calibration.error());
  if (has_no_data_sheet(options.robot)) calibrate::conclude_without_nominal(*calibration);
  calibration->notes.insert(calibration->notes.begin(), inputs->found.begin(), inputs->found.end());
  if (const std::string accuracy = pose_accuracy_sentence(*calibration); !accuracy.empty())
    calibration->notes.push_back(accuracy);
  if (auto done = write_results(options, inputs->robot, *calibration); !done) return fail(done.error());
  if (auto done = write_calibration_tables(options.out, task, *calibration); !done) return fail(done.error());
  if (auto done = record.write(options.out); !done) return fail(done.error());
  if (options.common.json)
    fmt::print("{}", format_calibration_headline(*calibration));
  else if (!options.common.quiet)
    print_summary(calibration_summary(*calibration), calibration->usable ? Tone::good : Tone::bad);
  return calibration->usable ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_calibrate(CLI::App& app) {
  CLI::App* verb =
      add_command(app, "calibrate", "Correct a robot's model from outside measurements, and prove the gain",
                  "No initial guess of base and tool is needed.\nExample:\n"
                  "  kinfer calibrate --robot robot.toml --data poses.csv --out calibration\n"
                  "  kinfer predict --chain calibration/chain.toml --joints joints.csv -o predicted.csv");
  auto options = std::make_shared<CalibrateArguments>();
  add_robot_option(*verb, options->robot, "--robot",
                   "Nominal model: " + readable_model_formats() + "; or unknown:6R, unknown:RRPR: joint types alone");
  add_text(*verb, "--data", options->data, "Pose set: joint readings and measurements", Requirement::required, "CSV");
  add_text(*verb, "--out", options->out, "Folder for chain.toml, chain.urdf, evidence.json, report.html, run.json",
           Requirement::required, "DIR");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_text(*verb, "--parameters", options->parameters,
           "auto: the complete geometric set; paper24: a alpha d theta of each joint (base and tool as given, or from "
           "the data where those disagree); or a TOML file "
           "with parameters = [\"a2\", ...]");
  add_text(*verb, "--model", options->model,
           "auto: geometry and what cross-validation shows to help beyond it; geometry; or some of gains, coupling, "
           "gravity, "
           "torques, gear, spectrum, backlash, temperature joined by +");
  add_choice(
      *verb, "--refit", options->refit, {"offsets"},
      "offsets: after a knock or a motor change, with few poses: only joint offsets, base and tool are found anew; "
      "all else stays as the earlier calibration (--warm-start) found it");
  add_text(*verb, "--holdout", options->holdout,
           "Rows that are never fitted: a fraction (0.2), or a further pose set (default: 5-fold cross-validation)");
  add_search_arguments(*verb, options->search);
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
