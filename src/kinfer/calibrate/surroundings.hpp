// What a pose set refers to besides the robot: sockets, planes, set-ups and arms get their place in the chain.
#pragma once

#include "kinfer/base/result.hpp"
#include "kinfer/kinematics/chain.hpp"
#include "kinfer/measurement/pose_set.hpp"

namespace kinfer {

/// A chain whose lists of sockets, planes and mountings are those that the pose set indexes.
struct PlacedData {
  Chain chain;
  PoseSet data;
};

/// Sockets and planes of the data in the data's order (with the place that the chain knows, if it knows one); one
/// mounting for each further set-up and each other tip that the rows name. Rows without a set-up belong to the chain's
/// own base and tool; where all rows name one, the first set-up named does. An error names an anchor, tip or
/// arm that the robot file lacks.
Result<PlacedData> with_surroundings(const Chain& chain, const PoseSet& data);

/// `chain` with those sockets and planes placed anew, by the mean tool point and by the plane through the tool points
/// of `judged`, that no row of `seen` has touched.
Chain with_unseen_surroundings(const Chain& chain, const PoseSet& seen, const PoseSet& judged);

/// `chain` with all sockets and planes placed by the tool points that it predicts: where a fit begins.
Chain with_placed_surroundings(const Chain& chain, const PoseSet& data);

}  // namespace kinfer
