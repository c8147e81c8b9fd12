// SPDX-License-Identifier: Apache-2.0
// kinfer verify: is an earlier calibration still good on new measurements?
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "kinfer/calibrate/diagnosis/diagnose.hpp"
#include "kinfer/cli/options/robot_option.hpp"
#include "kinfer/cli/parts/calibration_summary.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/cli/sweep/task_context.hpp"
#include "kinfer/cli/verb_list.hpp"
#include "kinfer/deploy/compare.hpp"
#include "kinfer/deploy/verify.hpp"
#include "kinfer/io/pose_set/pose_set_csv.hpp"
#include "kinfer/io/robot/toml/standard_deviations_toml.hpp"
#include "kinfer/io/text/dump_json.hpp"
#include "kinfer/words/calibration/checks.hpp"
#include "kinfer/words/findings/pose_set_findings.hpp"

namespace kinfer::cli {
namespace {

struct VerifyArguments {
  CommonOptions common;
  RobotOption chain;
  std::string data, columns, against;
};

void print(const Verification& v, const std::vector<std::string>& notes, const CommonOptions& common) {
  if (common.json) {
    const auto figures = [](const ErrorStatistics& s) {
      return nlohmann::ordered_json{{"mean", s.mean}, {"rms", s.rms}, {"sd", s.sd}, {"max", s.max}, {"n", s.n}};
    };
    const nlohmann::ordered_json json{{"verdict", words::verdict(v)},
                                      {"good", v.result == VerificationResult::valid},
                                      {"result", name(v.result)},
                                      {"as_it_stands", figures(v.unmodified)},
                                      {"frames_refitted", figures(v.frames_refitted)},
                                      {"redundancy", v.redundancy},
                                      {"notes", notes}};
    print_data(dump_json(json) + "\n");
  } else if (!common.quiet) {
    print_text("{}\n\n  as it stands            {}\n  base and tool refitted  {}\n", words::verdict(v),
               statistics_line(v.unmodified),
               v.redundancy > 0 ? statistics_line(v.frames_refitted) : "too few points to tell");
    for (const std::string& note : notes) print_text("  {}\n", note);
  }
}

struct DisplayUnit {
  double factor;
  const char* unit;
};
DisplayUnit display_unit_of_change(Quantity quantity) {
  if (quantity == Quantity::length) return {1e3, "mm"};
  if (quantity == Quantity::angle) return {1.0 / degree, "deg"};
  return {1.0, ""};
}

void print(const CalibrationComparison& changes, const CommonOptions& common) {
  if (common.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const ParameterChange& c : changes.parameters)
      list.push_back({{"name", c.name},
                      {"before", c.before},
                      {"after", c.after},
                      {"change", c.change},
                      {"sd", c.sd},
                      {"unit", unit(c.quantity)},
                      {"sigmas", c.sigmas},
                      {"significant", c.significant}});
    const nlohmann::ordered_json json{{"verdict", words::verdict(changes)},
                                      {"changed", changes.changed},
                                      {"tool_rms", changes.tool_rms},
                                      {"tool_worst", changes.tool_worst},
                                      {"parameters", list}};
    print_data(dump_json(json) + "\n");
    return;
  }
  if (common.quiet) return;
  print_text("{}\n\n  {:<12} {:>12} {:>12} {:>8}\n", words::verdict(changes), "number", "change", "sd", "sigma");
  constexpr std::size_t most = 12;
  for (std::size_t i = 0; i < std::min(most, changes.parameters.size()); ++i) {
    const ParameterChange& c = changes.parameters[i];
    const auto [factor, unit_name] = display_unit_of_change(c.quantity);
    print_text("  {:<12} {:>+12.5f} {:>12.5f} {:>+8.1f} {}{}\n", c.name, factor * c.change, factor * c.sd, c.sigmas,
               unit_name, c.significant ? "   changed" : "");
  }
}

Result<deploy::CalibratedRobot> read_calibrated(const RobotOption& option) {
  KINFER_TRY(robot, read_robot(option));
  KINFER_TRY(sd, read_standard_deviations(option.path));
  return deploy::CalibratedRobot{robot.chain, sd};
}

/// Changes from --chain to --against, tested with the standard deviations of both.
int run_comparison(const VerifyArguments& options) {
  const auto earlier = read_calibrated(options.chain);
  if (!earlier) return fail(earlier.error());
  const auto later = read_calibrated({options.against, {}, {}});
  if (!later) return fail(later.error());
  const auto changes = deploy::compare_calibrations(*earlier, *later);
  if (!changes) return fail({fmt::format("{}, {}: {}", options.chain.path, options.against, changes.error().what)});
  print(*changes, options.common);
  return changes->changed ? exit_do_not_use : exit_done;
}

bool is_of_units(FindingKind kind) {
  return kind == FindingKind::length_unit || kind == FindingKind::degrees_for_radians ||
         kind == FindingKind::radians_for_degrees;
}

/// Measurements in the units of the calibration, which corrects these by itself. Any other disagreement may be the
/// change that is sought: then they stay as they are.
struct MeasurementsInUnits {
  PoseSet data;
  std::vector<std::string> notes;
};

MeasurementsInUnits in_units_of(const RobotModel& robot, PoseSet data) {
  if (data.setups.size() > 1 || !data.tips.empty()) return {std::move(data), {}};
  const calibrate::Diagnosis diagnosis = calibrate::diagnose(
      {.nominal = robot.chain, .tolerances = robot.tolerances, .instrument = robot.instrument, .data = data});
  std::vector<std::string> notes;
  for (const Finding& finding : diagnosis.findings) {
    if (!finding.applied) continue;
    if (!is_of_units(finding.kind)) return {std::move(data), {}};
    notes.push_back(words::pose_set_finding_sentence(finding) +
                    "; corrected here (in the files: " + words::pose_set_finding_suggestion(finding) + ")");
  }
  if (!notes.empty()) data = diagnosis.corrected_task.data;
  return {std::move(data), std::move(notes)};
}

int run(const VerifyArguments& options) {
  if (!options.against.empty() && !options.data.empty())
    return fail({"verify: expected either --data or --against, not both"});
  if (!options.against.empty() && !options.columns.empty())
    return fail({"verify: --columns has no effect with --against"});
  if (!options.against.empty()) return run_comparison(options);
  if (options.data.empty())
    return fail({"verify: expected --data with new measurements, or --against a later chain.toml"});
  const auto robot = read_robot(options.chain);
  if (!robot) return fail(robot.error());
  const auto map = read_columns_option(options.columns);
  if (!map) return fail(map.error());
  const auto data = read_pose_set(options.data, robot->chain, *map);
  if (!data) return fail(data.error());
  const auto check = [&](const PoseSet& measured) {
    return deploy::verify(robot->chain, robot->tolerances, robot->instrument, measured, robot->prediction);
  };
  auto verification = check(*data);
  std::vector<std::string> notes;
  if (verification && verification->result != VerificationResult::valid) {
    MeasurementsInUnits measured = in_units_of(*robot, *data);
    notes = std::move(measured.notes);
    if (!notes.empty()) verification = check(measured.data);
  }
  if (!verification) return fail(verification.error());
  if (auto done = write_task_summary(*verification); !done) return fail(done.error());
  print(*verification, notes, options.common);
  return verification->result == VerificationResult::valid ? exit_done : exit_do_not_use;
}

}  // namespace

Verb add_verify(CLI::App& app) {
  CLI::App* verb = add_command(app, "verify", "Is an earlier calibration still good on new measurements?",
                               "Exit code 1: not good any more.\nExample:\n"
                               "  kinfer verify --chain calibration/chain.toml --data today.csv\n"
                               "  kinfer verify --chain may/chain.toml --against june/chain.toml");
  auto options = std::make_shared<VerifyArguments>();
  add_chain_option(*verb, options->chain, "chain.toml of the calibration, or the folder it is in");
  add_text(*verb, "--data", options->data, "New pose set", Requirement::optional, "CSV");
  add_model_file(*verb, "--against", options->against,
                 "A later calibration: which numbers have changed, by more than chance (exit code 1)",
                 Requirement::optional, "FILE");
  add_text(*verb, "--columns", options->columns, "How a foreign file's columns map to kinfer's", Requirement::optional,
           "TOML");
  add_common_options(*verb, options->common);
  return {verb, [options] { return run(*options); }};
}

}  // namespace kinfer::cli
