// SPDX-License-Identifier: Apache-2.0
// A calibration in words: the verdict, the notes and the recommendations.
#pragma once

#include <string>
#include <vector>

#include "kinfer/evidence/calibration/calibration.hpp"
#include "kinfer/evidence/facts/advice.hpp"

namespace kinfer::words {

/// "Use it: on poses that were not fitted the tool is …"
std::string verdict(const Calibration& calibration);
VerdictText verdict_text(const Calibration& calibration);  ///< its parts

/// The verdict in two words: "Use it", "Use with care", "Do not use", "Do not use without a look".
std::string verdict_headline(const Calibration& calibration);

/// "5-fold cross-validation"
std::string description(const HoldoutScheme& scheme);

std::string sentence(const CalibrationNote& note);

/// All remarks on a calibration: how an unknown robot was found, the findings but the outliers (the fit lists its own),
/// the notes, and the accuracy by ISO 9283.
std::vector<std::string> notes(const Calibration& calibration);

Advice advice(const CalibrationAdvice& advice);

/// Pose accuracy and, for repeated poses, repeatability by ISO 9283; empty where no tool point was measured.
std::string pose_accuracy(const std::vector<PoseAccuracy>& poses);

}  // namespace kinfer::words
