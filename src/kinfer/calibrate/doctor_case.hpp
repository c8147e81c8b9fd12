// What the checks of the doctor hand on from one to the next, and the quick fit that they judge by.
#pragma once

#include <optional>

#include "kinfer/calibrate/calibrate.hpp"
#include "kinfer/evidence/findings.hpp"

namespace kinfer {

/// The patient as the corrections so far leave it, and what was found.
struct DoctorCase {
  CalibrateTask task;
  std::vector<Finding> findings;
};

/// Adds a finding about `rows` (none: the whole set); their lines are looked up.
void add_finding(DoctorCase& patient, Finding finding);

/// "row 3", "rows 3, 5 and 9", "rows 12-40 and 44"
std::string rows_in_words(const std::vector<int>& rows);

/// The nominal chain with base and tool fitted to the points (there must be no orientations), and the median error that
/// is left [m]. Quick rather than exact: it is to tell millimetres from decimetres, hundreds of times.
struct QuickFit {
  Chain chain;
  double typical = 0.0;
};
std::optional<QuickFit> quick_fit(const Chain& nominal, const PoseSet& data);

/// At most `most` of the rows that hold points, evenly spread, with the points alone.
PoseSet thinned_points(const PoseSet& data, std::size_t most);

/// Error of a point [m] that tolerances and instrument can still excuse, base and tool refitted: four times what they
/// make one expect.
double believable_error(const CalibrateTask& task);

}  // namespace kinfer
