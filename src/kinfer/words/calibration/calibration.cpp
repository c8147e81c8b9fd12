// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/calibration.hpp"

#include <fmt/ranges.h>

#include <cmath>

#include "kinfer/words/calibration/unknown_robot.hpp"
#include "kinfer/words/findings/pose_set_findings.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

double mm(const FactValues& values, std::string_view key) {
  return 1e3 * values.number(key);
}

/// "J1=12°, J2=-40°, J3=85 mm"
std::string joint_positions(const FactValues& values) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < values.texts("joints").size(); ++i) {
    const double q = values.numbers("positions")[i];
    list.push_back(values.texts("joints")[i] + (values.counts("prismatic")[i] ? fmt::format("={:.0f} mm", 1e3 * q)
                                                                              : fmt::format("={:.0f}°", q / degree)));
  }
  return fmt::format("{}", fmt::join(list, ", "));
}

Advice advice_on_faults(const CalibrationAdvice& a) {
  const int n = a.values.count("faults");
  return {phrase(name(a.kind), "Correct the data as the findings say, and calibrate again"),
          phrase(name(a.kind), "{} fault{} and what was fitted to such data is of no use", n,
                 n == 1 ? " stands," : "s stand,")};
}

Advice advice_on_outliers(const CalibrationAdvice& a) {
  const int n = a.values.count("rows");
  return {
      phrase(name(a.kind), "Check the {} outlier row{}", n, n == 1 ? "" : "s"),
      phrase(
          name(a.kind),
          "they are excluded from the fit; a reason that is found now (a lost beam, a wrong row) saves the next set")};
}

Advice advice_on_joint_range(const CalibrationAdvice& a) {
  const std::string moved = a.values.has("range_rad") ? fmt::format("{:.0f}°", a.values.number("range_rad") / degree)
                                                      : fmt::format("{:.0f} mm", mm(a.values, "range_m"));
  return {phrase(name(a.kind), "Add poses that move {} further", a.values.text("joint")),
          phrase(name(a.kind), "it moved over {} only: what it does to the tool is hardly known", moved)};
}

}  // namespace

std::string description(const HoldoutScheme& scheme) {
  if (const auto* folds = std::get_if<HoldoutFolds>(&scheme))
    return phrase("cross_validation", "{}-fold cross-validation", folds->folds);
  if (const auto* part = std::get_if<HoldoutFraction>(&scheme))
    return phrase("fraction", "{:.0f} % of the rows, drawn at random", 100.0 * part->fraction);
  return phrase("labels", "rows marked holdout");
}

std::string sentence(const CalibrationNote& note) {
  const FactValues& values = note.values;
  switch (note.kind) {
    case CalibrationNoteKind::many_gross_errors:
      return phrase(
          name(note.kind),
          "{} of the rows that were held out lie where no noise explains it: too many to call the rows wrong, "
          "so all count in the held-out figures",
          values.count("rows"));
    case CalibrationNoteKind::tolerances_scaled:
      return phrase(name(note.kind),
                    "the nominal model is further off than its tolerances say: they were multiplied by {:.0f}",
                    values.number("factor"));
    case CalibrationNoteKind::frames_from_data:
      return phrase(name(note.kind),
                    "the base of the robot file lies {:.1f} mm from where the data show it: base and tool were taken "
                    "from the data",
                    mm(values, "distance_m"));
    case CalibrationNoteKind::urdf_geometry_only:
      return phrase(name(note.kind), "chain.urdf holds the geometry alone; chain.toml holds what goes beyond it");
    case CalibrationNoteKind::population_used:
      return phrase(name(note.kind),
                    "the prior is a population of {} robots; the data are {:.1e} times as likely with it as with the "
                    "tolerances of the data sheet",
                    values.count("robots"), std::exp(values.number("log_odds")));
    case CalibrationNoteKind::foreign_to_population:
      return phrase(
          name(note.kind),
          "this robot is foreign to the population of {} robots that was given as prior (odds 1 : {:.1e}): the "
          "tolerances of the data sheet were used instead",
          values.count("robots"), std::exp(-values.number("log_odds")));
    case CalibrationNoteKind::joint_offset_moved: {
      const bool length = values.has("change_m");
      return phrase(name(note.kind), "{} has moved by {:+.4f} {} since the earlier calibration ({:.0f} sd)",
                    values.text("parameter"), length ? mm(values, "change_m") : values.number("change_rad") / degree,
                    length ? "mm" : "deg", values.number("sigmas"));
    }
    case CalibrationNoteKind::no_offset_moved:
      return phrase(name(note.kind), "no joint offset has moved by more than chance explains");
  }
  return "";
}

std::string pose_accuracy(const std::vector<PoseAccuracy>& poses) {
  if (poses.empty()) return "";
  const auto [before, after, repeatability] = accuracy_statistics(poses);
  std::string text = phrase("iso9283",
                            "ISO 9283 over all rows: pose accuracy AP {:.3f} mm on average and {:.3f} mm at worst "
                            "({:.3f} and {:.3f} mm before)",
                            1e3 * after.mean, 1e3 * after.max, 1e3 * before.mean, 1e3 * before.max);
  if (repeatability.n > 0)
    text += fmt::format("; repeatability RP {:.3f} mm on average and {:.3f} mm at worst over {} repeated pose{}",
                        1e3 * repeatability.mean, 1e3 * repeatability.max, repeatability.n,
                        repeatability.n == 1 ? "" : "s");
  return text;
}

std::vector<std::string> notes(const Calibration& calibration) {
  std::vector<std::string> list;
  if (calibration.unknown_robot) list = unknown_robot_sentences(*calibration.unknown_robot);
  for (const Finding& finding : calibration.findings)
    if (finding.kind != FindingKind::gross_outliers) list.push_back(pose_set_finding_note(finding));
  for (const CalibrationNote& note : calibration.notes) list.push_back(sentence(note));
  if (std::string text = pose_accuracy(calibration.accuracy); !text.empty()) list.push_back(std::move(text));
  return list;
}

Advice advice(const CalibrationAdvice& a) {
  switch (a.kind) {
    case CalibrationAdviceKind::use_corrections:
      return {phrase(name(a.kind),
                     "Put the corrected numbers to use: offsets and DH table into the controller, or joint targets "
                     "through kinfer compensate"),
              phrase(name(a.kind), "the corrected model is in chain.toml, chain.urdf and the tables beside them")};
    case CalibrationAdviceKind::correct_data:
      return advice_on_faults(a);
    case CalibrationAdviceKind::check_model:
      return {phrase(name(a.kind),
                     "Look for what the model lacks: load, gears, temperature, a loose mount, or a worse instrument"),
              phrase(name(a.kind), "the residuals are {:.0f} times what the instrument explains",
                     a.values.number("residual_ratio"))};
    case CalibrationAdviceKind::check_outliers:
      return advice_on_outliers(a);
    case CalibrationAdviceKind::extend_joint_range:
      return advice_on_joint_range(a);
    case CalibrationAdviceKind::measure_uncertain_region:
      return {phrase(name(a.kind), "For a better model where it is least certain, add poses near {}",
                     joint_positions(a.values)),
              phrase(name(a.kind), "it expects {:.3f} mm there against {:.3f} mm over these poses",
                     mm(a.values, "error_there_m"), mm(a.values, "error_m"))};
    case CalibrationAdviceKind::measure_more_poses:
      return {
          phrase(name(a.kind), "For a better model everywhere, measure {} poses more; kinfer plan --data chooses them",
                 a.values.count("more")),
          phrase(name(a.kind),
                 "{} poses leave the model itself {:.3f} mm uncertain; from about {} poses on the gain is small",
                 a.values.count("poses"), mm(a.values, "error_m"), a.values.count("enough"))};
    case CalibrationAdviceKind::keep_verification_poses:
      return {phrase(name(a.kind), "Keep ten of these poses and measure them again now and then (kinfer verify)"),
              phrase(name(a.kind),
                     "it shows whether this calibration still holds after a crash, a new tool or a hot summer")};
  }
  return {};
}

}  // namespace kinfer::words
