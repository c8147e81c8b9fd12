// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/pose_set_findings.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/base/expect.hpp"
#include "kinfer/words/calibration_outliers.hpp"
#include "kinfer/words/language.hpp"
#include "kinfer/words/row_ranges.hpp"

namespace kinfer::words {
namespace {

double in_mm(const Finding& f, std::string_view value) {
  return 1e3 * f.values.number(value);
}
double in_deg(const Finding& f, std::string_view value) {
  return f.values.number(value) / degree;
}

std::string_view unit_name(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> names{
      {{"mm", "millimetres"}, {"m", "metres"}, {"in", "inches"}, {"deg", "degrees"}, {"rad", "radians"}}};
  return std::ranges::find(names, unit, &std::pair<std::string_view, std::string_view>::first)->second;
}

// ---- joint positions and measurements that do not belong together ----

std::string rows_shifted(const Finding& f) {
  const int shift = f.values.count("shift"), by = std::abs(shift);
  return phrase(name(f.kind),
                "{}the joint readings are shifted by {} row{} against the measurements: those of row i belong to the "
                "measurement of row i {} {}",
                f.values.count("whole_set") ? "" : "in " + row_ranges(f.rows) + " ", by, by == 1 ? "" : "s",
                shift > 0 ? "-" : "+", by);
}
std::string rows_shifted_remedy(const Finding& f) {
  return f.values.count("whole_set") ? phrase(name(f.kind), "pair the rows anew in the file")
                                     : phrase(name(f.kind), "a row is missing or was taken twice where this begins");
}

std::string rows_swapped(const Finding& f) {
  return phrase(name(f.kind), "the measurements of rows {} and {} are swapped", f.rows.at(0), f.rows.at(1));
}
std::string rows_swapped_remedy(const Finding& f) {
  return phrase(name(f.kind), "exchange them in the file; as they are, calibrate rejects them as outliers");
}

std::string base_moved(const Finding& f) {
  if (f.values.has("from_row"))
    return phrase(
        name(f.kind),
        "from row {} on, the tool is seen {:.3f} mm elsewhere: the robot, the instrument or the tool was moved "
        "a little",
        f.values.count("from_row"), in_mm(f, "distance_m"));
  return phrase(name(f.kind),
                "in {} the tool is {:.1f} mm elsewhere, and one other place of base and tool explains all of them: the "
                "robot, the instrument or the tool was moved",
                row_ranges(f.rows), in_mm(f, "distance_m"));
}
std::string base_moved_remedy(const Finding& f) {
  if (f.values.has("from_row"))
    return phrase(name(f.kind), "give the rows from {} on a setup of their own", f.values.count("from_row"));
  return phrase(name(f.kind), "give these rows a setup of their own in a column called setup");
}

std::string base_drifts(const Finding& f) {
  return phrase(name(f.kind),
                "the tool is seen to drift by {:.3f} mm from the first row to the last: the base or the instrument "
                "moves, or the robot warms up",
                in_mm(f, "distance_m"));
}
std::string base_drifts_remedy(const Finding& f) {
  return phrase(name(f.kind), "warm up first, measure in random order, and measure the base again in between");
}

// ---- conventions ----

/// Of one joint, of all joint positions ("joints"), or of the measured positions.
std::string wrong_unit(const Finding& f) {
  const std::string_view unit = unit_name(f.values.text("unit")), read_as = unit_name(f.values.text("read_as"));
  if (f.values.has("joint"))
    return phrase(name(f.kind), "{} is in {}, but was read as {}", f.values.text("joint"), unit, read_as);
  if (f.kind == FindingKind::length_unit)
    return phrase(name(f.kind), "the measured positions are {}, but were read as {}", unit, read_as);
  return phrase(name(f.kind), "the joint readings are {}, but were read as {}", unit, read_as);
}
std::string wrong_unit_remedy(const Finding& f) {
  const std::string& unit = f.values.text("unit");
  if (f.values.has("joint"))
    return phrase(name(f.kind), "write its unit into the header: q{}[{}]", f.values.count("column"), unit);
  if (f.kind != FindingKind::length_unit)
    return phrase(name(f.kind), "write the unit into the header: q1[{0}], q2[{0}], ...", unit);
  if (unit == "in") return phrase(name(f.kind), "convert them: kinfer knows m, mm and um");
  return phrase(name(f.kind), "write the unit into the header: x[{0}], y[{0}], z[{0}]", unit);
}

std::string wrong_sign(const Finding& f) {
  return phrase(name(f.kind), "{} counts in the other sense than the robot file says", f.values.text("joint"));
}
std::string wrong_sign_remedy(const Finding& f) {
  return phrase(name(f.kind), "give {} gain = {:g} in the robot file", f.values.text("joint"), f.values.number("gain"));
}

std::string joint_offset(const Finding& f) {
  return phrase(name(f.kind), "{} is {:.0f} deg off its zero in the robot file", f.values.text("joint"),
                in_deg(f, "offset_rad"));
}
std::string joint_offset_remedy(const Finding& f) {
  return phrase(name(f.kind), "add {:.0f} deg to the zero position (theta) of {} in the robot file",
                in_deg(f, "offset_rad"), f.values.text("joint"));
}

std::string columns_swapped(const Finding& f) {
  const std::vector<std::string>& joints = f.values.texts("joints");
  return phrase(name(f.kind), "the readings of {} and {} are exchanged", joints.at(0), joints.at(1));
}
std::string columns_swapped_remedy(const Finding& f) {
  const std::vector<int>& columns = f.values.counts("columns");
  return phrase(name(f.kind), "exchange the headers of q{} and q{}", columns.at(0), columns.at(1));
}

std::string joint_coupled(const Finding& f) {
  return phrase(name(f.kind), "{} moves {} {}: a belt or a parallel linkage couples them", f.values.text("joint"),
                f.values.count("factor") > 0 ? "with" : "against", f.values.text("follows"));
}
std::string joint_coupled_remedy(const Finding& f) {
  return phrase(name(f.kind), "give {} coupling = {{ {} = {} }} in the robot file", f.values.text("joint"),
                f.values.text("follows"), f.values.count("factor"));
}

std::string mirrored(const Finding& f) {
  return phrase(name(f.kind), "the measured positions are a mirror image: their axes are not right-handed");
}
std::string mirrored_remedy(const Finding& f) {
  return phrase(name(f.kind), "change the sign of one of x, y, z, or exchange two of them");
}

std::string robot_length_unit(const Finding& f) {
  return phrase(name(f.kind), "the robot reaches {:g} m by its file", f.values.number("reach_m"));
}
std::string robot_length_unit_remedy(const Finding& f) {
  return phrase(name(f.kind), "check units = {{ length = ... }} in the robot file");
}

/// A convention of quaternions: its name in the finding's values, how they are to be read, and what to change.
struct QuaternionWords {
  std::string_view convention, read, remedy;
};
constexpr std::array quaternion_words{
    QuaternionWords{"inverse", "inverted: they turn world coordinates into the tool's",
                    "write the inverse rotations (qx, qy, qz negated)"},
    QuaternionWords{"scalar_last", "in the order x, y, z, w", "rename the columns: qx, qy, qz, qw"},
    QuaternionWords{"mirrored_x", "left-handed: their axes are mirrored in x", "change the signs of qy and qz"},
    QuaternionWords{"mirrored_y", "left-handed: their axes are mirrored in y", "change the signs of qx and qz"},
    QuaternionWords{"mirrored_z", "left-handed: their axes are mirrored in z", "change the signs of qx and qy"}};

const QuaternionWords& words_of_quaternions(const Finding& f) {
  const auto at = std::ranges::find(quaternion_words, f.values.text("quaternions"), &QuaternionWords::convention);
  KINFER_EXPECT(at != quaternion_words.end());
  return *at;
}

std::string orientation_convention(const Finding& f) {
  if (!f.values.has("remaining_rad"))
    return phrase(name(f.kind),
                  "the orientations disagree with the joints by {:.0f} deg, and no other convention that was tried "
                  "explains them",
                  in_deg(f, "disagreement_rad"));
  const std::string read = f.values.has("euler")
                               ? fmt::format("as {} angles in {}", f.values.text("euler"), f.values.text("unit"))
                               : std::string(words_of_quaternions(f).read);
  return phrase(name(f.kind),
                "the orientations disagree with the joints by {:.0f} deg; they agree to {:.2f} deg when read {}",
                in_deg(f, "disagreement_rad"), in_deg(f, "remaining_rad"), read);
}
std::string orientation_convention_remedy(const Finding& f) {
  if (!f.values.has("remaining_rad")) return phrase(name(f.kind), "check their order, sense and unit");
  if (f.values.has("euler"))
    return phrase(name(f.kind), "write euler = \"{}\" into the column map, and rx, ry, rz in [{}]",
                  f.values.text("euler"), f.values.text("unit"));
  return phrase(name(f.kind), "{}", words_of_quaternions(f).remedy);
}

// ---- rows ----

std::string not_settled(const Finding& f) {
  if (f.values.has("commanded_error_m"))
    return phrase(name(f.kind),
                  "the read-back joints were taken while the arm still moved: they differ from the commanded ones by "
                  "{:.3f} deg typically, and the commanded ones explain the points to {:.3f} mm instead of {:.3f} mm",
                  in_deg(f, "difference_rad"), in_mm(f, "commanded_error_m"), in_mm(f, "measured_error_m"));
  if (!f.rows.empty())
    return phrase(name(f.kind),
                  "in {} commanded and read-back joints differ far more than elsewhere: the arm had not come to rest",
                  row_ranges(f.rows));
  return phrase(name(f.kind),
                "commanded and read-back joints differ by {:.3f} deg typically: was the arm still moving?",
                in_deg(f, "difference_rad"));
}
std::string not_settled_remedy(const Finding& f) {
  if (f.values.has("commanded_error_m"))
    return phrase(name(f.kind), "use the commanded joints, or read back after the arm has come to rest");
  return f.rows.empty() ? phrase(name(f.kind), "read back after the arm has come to rest")
                        : phrase(name(f.kind), "measure these rows again or leave them out");
}

std::string gross_outliers(const Finding& f) {
  const bool one = f.rows.size() == 1;
  std::vector<OutlierReason> reasons;
  const std::vector<std::string>& kinds = f.values.texts("kinds");
  for (std::size_t i = 0; i < kinds.size(); ++i)
    reasons.push_back({*measurement_kind(kinds[i]), f.values.numbers("residuals")[i], f.values.numbers("sigmas")[i]});
  return phrase(name(f.kind), "{} {} where no noise explains it: {}{}", row_ranges(f.rows), one ? "lies" : "lie",
                one ? "" : "in the first ", outlier_reasons(reasons));
}
std::string gross_outliers_remedy(const Finding& f) {
  return phrase(name(f.kind), "calibrate rejects such rows as outliers; look at them");
}

std::string joint_hardly_moves(const Finding& f) {
  return phrase(name(f.kind), "{} hardly moves; its parameters cannot be determined", f.values.text("joint"));
}
std::string joint_hardly_moves_remedy(const Finding& f) {
  return phrase(name(f.kind), "measure poses in which {} moves (kinfer plan proposes some)", f.values.text("joint"));
}

std::string outside_limits(const Finding& f) {
  return phrase(name(f.kind), "{} reads beyond its limits in {}", f.values.text("joint"), row_ranges(f.rows));
}
std::string outside_limits_remedy(const Finding& f) {
  return phrase(name(f.kind), "check the limits in the robot file, and the unit and sign of this reading");
}

std::string duplicate_rows(const Finding& f) {
  return phrase(name(f.kind), "{} are copies of one another: the same joints and the same measurement",
                row_ranges(f.rows));
}
std::string measurement_repeated(const Finding& f) {
  return phrase(name(f.kind), "{} hold the same measurement although the joints moved", row_ranges(f.rows));
}
std::string repeated_remedy(const Finding& f) {
  return phrase(name(f.kind), "measure these rows again or leave them out");
}

std::string target_name(const std::string& target) {
  return target.empty() ? "the tool point" : "target " + target;
}
std::string not_rigid(const Finding& f) {
  const std::vector<std::string>& targets = f.values.texts("targets");
  const std::string which = fmt::format("{} from {}", target_name(targets.at(1)), target_name(targets.at(0)));
  if (!f.rows.empty())
    return phrase(name(f.kind), "the distance of {} is {:.3f} mm, but not in {}", which, in_mm(f, "distance_m"),
                  row_ranges(f.rows));
  return phrase(
      name(f.kind),
      "the distance of {} changes by {:.3f} mm from row to row, more than the instrument's {:.3f} mm explains", which,
      in_mm(f, "sd_m"), in_mm(f, "sigma_m"));
}
std::string not_rigid_remedy(const Finding& f) {
  return f.rows.empty() ? phrase(name(f.kind), "fasten the targets, or let the arm come to rest before measuring")
                        : phrase(name(f.kind), "these rows hold a wrong point: measure them again or leave them out");
}

struct FindingWords {
  FindingKind kind;
  std::string (*sentence)(const Finding&);
  std::string (*suggestion)(const Finding&);
};
constexpr std::array finding_words{
    FindingWords{FindingKind::rows_shifted, rows_shifted, rows_shifted_remedy},
    FindingWords{FindingKind::rows_swapped, rows_swapped, rows_swapped_remedy},
    FindingWords{FindingKind::base_moved, base_moved, base_moved_remedy},
    FindingWords{FindingKind::base_drifts, base_drifts, base_drifts_remedy},
    FindingWords{FindingKind::degrees_for_radians, wrong_unit, wrong_unit_remedy},
    FindingWords{FindingKind::radians_for_degrees, wrong_unit, wrong_unit_remedy},
    FindingWords{FindingKind::length_unit, wrong_unit, wrong_unit_remedy},
    FindingWords{FindingKind::wrong_sign, wrong_sign, wrong_sign_remedy},
    FindingWords{FindingKind::joint_offset, joint_offset, joint_offset_remedy},
    FindingWords{FindingKind::columns_swapped, columns_swapped, columns_swapped_remedy},
    FindingWords{FindingKind::joint_coupled, joint_coupled, joint_coupled_remedy},
    FindingWords{FindingKind::mirrored, mirrored, mirrored_remedy},
    FindingWords{FindingKind::robot_length_unit, robot_length_unit, robot_length_unit_remedy},
    FindingWords{FindingKind::orientation_convention, orientation_convention, orientation_convention_remedy},
    FindingWords{FindingKind::not_settled, not_settled, not_settled_remedy},
    FindingWords{FindingKind::gross_outliers, gross_outliers, gross_outliers_remedy},
    FindingWords{FindingKind::joint_hardly_moves, joint_hardly_moves, joint_hardly_moves_remedy},
    FindingWords{FindingKind::outside_limits, outside_limits, outside_limits_remedy},
    FindingWords{FindingKind::duplicate_rows, duplicate_rows, repeated_remedy},
    FindingWords{FindingKind::measurement_repeated, measurement_repeated, repeated_remedy},
    FindingWords{FindingKind::not_rigid, not_rigid, not_rigid_remedy},
};

const FindingWords& words_of(FindingKind kind) {
  const auto at = std::ranges::find(finding_words, kind, &FindingWords::kind);
  KINFER_EXPECT(at != finding_words.end(), "{} is not a finding about pose sets", name(kind));
  return *at;
}

}  // namespace

std::string pose_set_finding_sentence(const Finding& finding) {
  std::string text = words_of(finding.kind).sentence(finding);
  for (const Finding& other : finding.equivalents)
    text += "; or, which comes to the same, " + words_of(other.kind).sentence(other);
  return text;
}

std::string pose_set_finding_suggestion(const Finding& finding) {
  return words_of(finding.kind).suggestion(finding);
}

std::string pose_set_finding_note(const Finding& finding) {
  const std::string remedy = pose_set_finding_suggestion(finding);
  const std::string text = pose_set_finding_sentence(finding);
  if (finding.applied) return text + "; corrected before the fit (in the files: " + remedy + ")";
  return text + "; " + remedy;
}

}  // namespace kinfer::words
