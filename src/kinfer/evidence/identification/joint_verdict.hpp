// SPDX-License-Identifier: Apache-2.0
// Whether each identified joint may be used, and the evidence that this rests on.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/evidence/facts/fact.hpp"

namespace kinfer {

enum class JointUsability {
  use,            ///< connected, in a safe order, as accurate as wanted
  use_with_care,  ///< connected, but something is doubtful or less accurate than wanted
  do_not_use,     ///< the evidence is against this joint
  unknown         ///< the recording does not tell: it never moved, or nothing of its axis is determined
};
std::string_view name(JointUsability usability);  ///< "use", "use_with_care", "do_not_use", "unknown"

/// Why a joint is not simply used.
enum class JointDoubtKind {
  not_connected,       ///< gain, needed [nats]: predicts the motion no better than recordings shifted in time
  weakly_connected,    ///< gain, needed [nats]
  partly_connected,    ///< begin, end [s]: connected there only
  changed,             ///< no values: the two halves of the recording need different joints
  beyond_reach,        ///< sensor, distance, reach [m]
  not_moved,           ///< no values
  undetermined,        ///< no values: nothing is known of its axis or of its point
  unsafe_order,        ///< first, second: the pair that would replace it; margin, safe_margin
  not_fitted,          ///< no values: the fit of the whole recording failed, the joint is that of two sensors
  unexplained_motion,  ///< sensor, ratio: of the residual noise to the instrument's
  uncertain_type,      ///< types, probabilities: of those that are possible, most probable first
  inaccurate,          ///< line_sd [m], direction_sd [rad]
};
std::string_view name(JointDoubtKind kind);  ///< "not_connected", ...

struct JointDoubt {
  JointDoubtKind kind{};
  FactValues values{};
};

/// How much better a joint explains the motion of its two segments than no joint: decrease of the code length of their
/// relative motion against the same fit with one of them shifted in time.
struct JointConnection {
  double force_gain = 0.0;        ///< [nats per row] of the acceleration at the joint's point
  double rate_gain = 0.0;         ///< [nats per row] of the relative angular velocity
  double gain_spread = 0.0;       ///< [nats per row] standard deviation over the shifts of the sum of both
  double residual = 0.0;          ///< [m/s²] rms acceleration residual of the pair as recorded
  double shifted_residual = 0.0;  ///< [m/s²] of the shifted fits
  double shifted_rate = 0.0;      ///< [rad/s] rms relative angular velocity across its axis, of the shifted fits

  double gain() const { return force_gain + rate_gain; }
};

struct JointVerdict {
  std::string joint;  ///< "ins1-ins2"
  JointUsability usability = JointUsability::use;
  JointConnection connection{};
  std::vector<JointDoubt> doubts{};  ///< most serious first
};

}  // namespace kinfer
