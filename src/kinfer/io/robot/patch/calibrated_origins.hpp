// SPDX-License-Identifier: Apache-2.0
// The origins that the joints of a robot file get from a calibrated chain.
#pragma once

#include <string>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/evidence/calibration/model_patch.hpp"
#include "kinfer/geometry/pose.hpp"
#include "kinfer/kinematics/chain.hpp"

namespace kinfer {

struct CalibratedOrigin {
  std::string joint;
  bool translates = false;
  Pose before, after;   ///< of the joint in the chain; before the motion by a mimic joint's offset they are the file's
  double offset = 0.0;  ///< [rad] or [m] to be added to joint positions; 0 where folded

  /// after · before⁻¹ · `in_file`: a mimic joint's offset is part of its origin in a chain, but not in the file.
  Pose replacement(const Pose& in_file) const;
};

/// Of every joint that moves. `in_file`: the chain as read from the file, whose joints follow each other as in
/// `corrected`. An error where `corrected` is another machine,
/// or has numbers that no file may hold.
Result<std::vector<CalibratedOrigin>> calibrated_origins(const Chain& in_file, const Chain& corrected,
                                                         EncoderOffsets offsets);

/// Change of a URDF joint's zero: along its axis [m] or about it [rad].
double zero_offset(const Joint& before, const Joint& after);

}  // namespace kinfer
