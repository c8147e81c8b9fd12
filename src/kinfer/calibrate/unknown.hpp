// A robot without a data sheet: joint types and measurements alone give its chain, and a data sheet is written from it.
//
// The sheet is rounded to what a maker would print, so that the calibration that follows starts from numbers that no
// measured row has chosen, and proves itself on held-out rows as any other.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/base/rng.hpp"
#include "kinfer/evidence/calibration.hpp"
#include "kinfer/kinematics/parameters.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// Neighbouring axes of a straight chain in words: "J2 and J3 are parallel, 612.0 mm apart"; "J4, J5 and J6 meet in one
/// point".
std::vector<std::string> axes_in_words(const Chain& chain);

struct UnknownRobot {
  Chain sheet;            ///< MDH, lengths rounded to 1 mm, angles to 1°
  Tolerances tolerances;  ///< what the rounding leaves open
  std::vector<std::string> words;
};

/// The verdict on a calibration that started from such a sheet: there is no model before it to be better than.
void judge_without_sheet(Calibration& calibration);

/// `joint_types` as "6R" or "RRPR".
Result<UnknownRobot> find_unknown_robot(const std::string& joint_types, const PoseSet& data, int threads, Rng rng);

}  // namespace kinfer
