// SPDX-License-Identifier: Apache-2.0
// What the reader of a pose set expects of its file.
#pragma once

namespace kinfer {

/// What a file must hold besides the joint positions. `joints_only`, for prediction: nothing; a row with an anchor but
/// no distance then has NaN for its distance. `targets`, for compensation: the desired positions of the tool point; the
/// joint positions, which serve as start values, may be absent (PoseSet::joints then has no rows).
enum class RequiredContent { measurements, joints_only, targets };

}  // namespace kinfer
