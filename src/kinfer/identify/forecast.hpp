// Whether a drive is enough, joint by joint, and what more it would take.
#pragma once

#include "kinfer/evidence/identification.hpp"

namespace kinfer {

/// What is wanted of every joint, in 95 of 100 cases.
struct WantedAccuracy {
  double line = 5e-3;       ///< [m]
  double direction = 3e-3;  ///< [rad]
};

/// From the standard deviations of what the recording can tell at all. Errors fall with the square root of the time and
/// in proportion to the accelerations.
std::vector<JointForecast> forecast(const std::vector<FoundJoint>& joints, const WantedAccuracy& wanted = {});

/// Whether a brisker or longer drive of the same kind can be expected to tell a joint that is lacking.
bool a_drive_would_do(const JointForecast& joint);

bool enough_for_all(const std::vector<JointForecast>& joints);

/// How the parent is turned about the only axis that it turns about is known worse than any direction should be.
bool is_vague_azimuth(const JointForecast& joint, const WantedAccuracy& wanted = {});

/// "the turn of ins1 about its only axis (± 11 mrad)"
std::string azimuth_in_words(const JointForecast& joint);

/// "± 0.7 mm and ± 0.24 mrad": one standard deviation of the worst joint, both directions across it together;
/// nothing where none is known.
std::string accuracy_in_words(const std::vector<JointForecast>& joints);

/// "enough for 5 mm and 3 mrad in every joint", or which joints need what.
std::string in_words(const std::vector<JointForecast>& joints, const WantedAccuracy& wanted = {});

}  // namespace kinfer
