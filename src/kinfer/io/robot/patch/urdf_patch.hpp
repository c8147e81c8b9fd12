// SPDX-License-Identifier: Apache-2.0
// A URDF file with new joint origins, and every other byte as it was.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinfer/base/result.hpp"
#include "kinfer/io/robot/patch/calibrated_origins.hpp"
#include "kinfer/io/robot/patch/xml_edits.hpp"

namespace kinfer {

/// Changes the values of xyz and rpy, and adds them, or the whole <origin>, where the file has none, in the style of
/// the elements beside. Numbers are written such that they read back to the same bits.
Result<PatchedText> patch_urdf(std::string_view text, const std::string& name_in_messages,
                               const std::vector<CalibratedOrigin>& origins);

/// Roll, pitch and yaw of R: of the angles that mean the same rotation those nearest to `like`.
Vec3 rpy_near(const Mat3& rotation, const Vec3& like);

}  // namespace kinfer
