// SPDX-License-Identifier: Apache-2.0
// A four-bar linkage at a machine's last joint, like the one that moves an excavator's bucket: a kinematic loop, which
// no tree can represent.
//
// In the plane across the joint's axis, with B the joint, A a point of the segment before it at the distance `ground`,
// C a point of the last segment at `crank` from B: a rocker of length `rocker` rotates about A, a coupler of length
// `coupler` joins its end to C. The angles follow from the triangle of A, C and the rocker's end (law of cosines).
#pragma once

#include "kinfer/simulate/excitation.hpp"
#include "kinfer/simulate/machine_motion.hpp"

namespace kinfer {

/// The defaults close within the range of an excavator's bucket.
struct FourBar {
  double ground = 0.45, crank = 0.35, rocker = 0.36, coupler = 0.47;  ///< [m]
  double crank_angle = 1.0;  ///< [rad] of C against the line from A to B, at joint position 0
};

/// The machine with rocker and coupler as two more joints in a branch, with an INS on each. The chain leaves the loop
/// open; the motion closes it.
Machine with_linkage(Machine machine, const FourBar& bars = {});

/// Signals of ideal sensors while the joints of the machine without linkage follow the drive exactly.
MachineMotion linkage_motion(const Machine& with_linkage, const Drive& drive, double sampling_rate,
                             const FourBar& bars = {});

}  // namespace kinfer
