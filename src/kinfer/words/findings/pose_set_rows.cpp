// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "kinfer/measurement/measurements.hpp"
#include "kinfer/words/findings/finding_words.hpp"
#include "kinfer/words/findings/outliers.hpp"
#include "kinfer/words/findings/row_ranges.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string rows_shifted(const Finding& f) {
  const int shift = f.values.count("shift"), by = std::abs(shift);
  return phrase(name(f.kind),
                "{}the joint positions are shifted by {} row{} against the measurements: those of row i belong to the "
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
        f.values.count("from_row"), value_in_mm(f, "distance_m"));
  return phrase(name(f.kind),
                "in {} the tool is {:.1f} mm elsewhere, and one other place of base and tool explains all of them: the "
                "robot, the instrument or the tool was moved",
                row_ranges(f.rows), value_in_mm(f, "distance_m"));
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
                value_in_mm(f, "distance_m"));
}
std::string base_drifts_remedy(const Finding& f) {
  return phrase(name(f.kind), "warm up first, measure in random order, and measure the base again in between");
}

/// Where the points lie between read-back (0 %) and commanded joints (100 %).
std::string lag_from_read_back(const Finding& f) {
  if (!f.values.has("lag")) return "";
  return fmt::format("; the points lie {:.1f} % +- {:.1f} % of the way from the read-back to the commanded joints",
                     100.0 * f.values.number("lag"), 100.0 * f.values.number("lag_sd"));
}

std::string typical_difference(const Finding& f) {
  const bool turns = f.values.has("difference_rad"), slides = f.values.has("difference_m");
  const std::string angle = turns ? fmt::format("{:.3f} deg", value_in_deg(f, "difference_rad")) : "",
                    length = slides ? fmt::format("{:.3f} mm", value_in_mm(f, "difference_m")) : "";
  return turns && slides ? angle + " and " + length : angle + length;
}

std::string not_settled(const Finding& f) {
  if (f.values.has("commanded_error_m"))
    return phrase(name(f.kind),
                  "the read-back joints were taken while the arm still moved: they differ from the commanded ones by "
                  "{} typically, and the commanded ones explain the points to {:.3f} mm instead of {:.3f} mm{}",
                  typical_difference(f), value_in_mm(f, "commanded_error_m"), value_in_mm(f, "measured_error_m"),
                  lag_from_read_back(f));
  if (!f.rows.empty())
    return phrase(name(f.kind),
                  "in {} commanded and read-back joints differ far more than elsewhere: the arm had not come to rest",
                  row_ranges(f.rows));
  return phrase(name(f.kind), "commanded and read-back joints differ by {} typically: was the arm still moving?",
                typical_difference(f));
}
std::string not_settled_remedy(const Finding& f) {
  if (f.values.has("commanded_error_m"))
    return phrase(name(f.kind), "use the commanded joints, or read back after the arm has come to rest");
  return f.rows.empty() ? phrase(name(f.kind), "read back after the arm has come to rest")
                        : phrase(name(f.kind), "measure these rows again or leave them out");
}

std::string joint_lag(const Finding& f) {
  const double lag = f.values.number("lag");
  const bool last = f.values.text("motion") == "last";
  const char* reading = last ? (lag > 0.0 ? "the joints were read" : "the points were measured")
                             : (lag > 0.0 ? "the points were measured" : "the joints were read");
  return phrase(name(f.kind),
                "the residuals point along the motion {}, {:.3f} mm of {:.3f} mm rms: it seems that {} {} {:.2f} % "
                "+- {:.2f} % of that motion",
                last ? "from the row before" : "to the next row", value_in_mm(f, "distance_m"),
                value_in_mm(f, "error_m"), reading, last ? "before the last" : "after the first", 100.0 * std::abs(lag),
                100.0 * f.values.number("lag_sd"));
}
std::string joint_lag_remedy(const Finding& f) {
  return f.values.text("motion") == "last"
             ? phrase(name(f.kind),
                      "let the arm come to rest before joints and points are read, or give q1_cmd, q2_cmd, ...")
             : phrase(name(f.kind), "read joints and points before the arm moves on");
}

bool is_about_tapes(const Finding& f) {
  return f.values.text("facts") == "tapes";
}

/// Of tapes and surveyed points beside a recording.
std::string wrong_fact(const Finding& f) {
  const double distance = value_in_mm(f, "distance"), sigma = value_in_mm(f, "sigma");
  const char* end = f.applied ? "it was not used" : "which of the facts is wrong cannot be told";
  if (is_about_tapes(f))
    return phrase(name(f.kind),
                  "tape {} differs by {:.0f} mm from what the recording and the other facts say, at a stated sigma of "
                  "{:.3g} mm: {}",
                  f.rows[0] + 1, distance, sigma, end);
  return phrase(name(f.kind),
                "surveyed point {} lies {:.0f} mm from where the recording and the other facts put it, at a stated "
                "sigma of {:.3g} mm: {}",
                f.rows[0] + 1, distance, sigma, end);
}

std::string gross_outliers(const Finding& f) {
  if (f.values.has("facts")) return wrong_fact(f);
  const bool one = f.rows.size() == 1;
  std::vector<OutlierReason> reasons;
  const std::vector<std::string>& kinds = f.values.texts("kinds");
  for (std::size_t i = 0; i < kinds.size(); ++i)
    reasons.push_back({*measurement_kind(kinds[i]), f.values.numbers("residuals")[i], f.values.numbers("sigmas")[i]});
  return phrase(name(f.kind), "{} {} where no noise explains it: {}{}", row_ranges(f.rows), one ? "lies" : "lie",
                one ? "" : "in the first ", outlier_reasons(reasons));
}
std::string gross_outliers_remedy(const Finding& f) {
  if (f.values.has("facts"))
    return phrase(name(f.kind), "{} again, or correct it in the file of --facts",
                  is_about_tapes(f) ? "measure the length" : "survey the point");
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
  return phrase(name(f.kind), "check the limits in the robot file, and the unit and sign of this joint position");
}

std::string outside_region(const Finding& f) {
  return phrase(name(f.kind),
                "{} {} outside the joint positions that the calibration measured, up to {:.1f} times as far",
                row_ranges(f.rows), f.rows.size() == 1 ? "lies" : "lie", f.values.number("largest_distance"));
}
std::string outside_region_remedy(const Finding& f) {
  return phrase(name(f.kind), "measure some poses there and calibrate with them; until then the error may be larger");
}

std::string duplicate_rows(const Finding& f) {
  return phrase(name(f.kind), "{} are copies of one another, the same joints and the same measurement: they count once",
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
    return phrase(name(f.kind), "the distance of {} is {:.3f} mm, but not in {}", which, value_in_mm(f, "distance_m"),
                  row_ranges(f.rows));
  return phrase(
      name(f.kind),
      "the distance of {} changes by {:.3f} mm from row to row, more than the instrument's {:.3f} mm explains", which,
      value_in_mm(f, "sd_m"), value_in_mm(f, "sigma_m"));
}
std::string not_rigid_remedy(const Finding& f) {
  return f.rows.empty() ? phrase(name(f.kind), "fasten the targets, or let the arm come to rest before measuring")
                        : phrase(name(f.kind), "these rows hold a wrong point: measure them again or leave them out");
}

constexpr std::array words_of_rows{
    FindingWords{FindingKind::rows_shifted, rows_shifted, rows_shifted_remedy},
    FindingWords{FindingKind::rows_swapped, rows_swapped, rows_swapped_remedy},
    FindingWords{FindingKind::base_moved, base_moved, base_moved_remedy},
    FindingWords{FindingKind::base_drifts, base_drifts, base_drifts_remedy},
    FindingWords{FindingKind::not_settled, not_settled, not_settled_remedy},
    FindingWords{FindingKind::joint_lag, joint_lag, joint_lag_remedy},
    FindingWords{FindingKind::gross_outliers, gross_outliers, gross_outliers_remedy},
    FindingWords{FindingKind::joint_hardly_moves, joint_hardly_moves, joint_hardly_moves_remedy},
    FindingWords{FindingKind::outside_limits, outside_limits, outside_limits_remedy},
    FindingWords{FindingKind::outside_region, outside_region, outside_region_remedy},
    FindingWords{FindingKind::duplicate_rows, duplicate_rows, repeated_remedy},
    FindingWords{FindingKind::measurement_repeated, measurement_repeated, repeated_remedy},
    FindingWords{FindingKind::not_rigid, not_rigid, not_rigid_remedy}};

}  // namespace

std::span<const FindingWords> row_words() {
  return words_of_rows;
}

}  // namespace kinfer::words
