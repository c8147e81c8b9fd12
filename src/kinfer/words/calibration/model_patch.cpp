// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/model_patch.hpp"

#include <algorithm>

#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string_view noun(NonGeometricKind kind) {
  switch (kind) {
    case NonGeometricKind::gain:
      return "gains of encoders or drives";
    case NonGeometricKind::coupling:
      return "couplings between joints";
    case NonGeometricKind::compliance:
      return "compliances under gravity";
    case NonGeometricKind::torque_compliance:
      return "compliances under measured torques";
    case NonGeometricKind::backlash:
      return "backlash";
    case NonGeometricKind::harmonics:
      return "harmonics of gears";
    case NonGeometricKind::expansion:
      return "thermal expansion";
    case NonGeometricKind::field:
      return "the displacement field";
  }
  return "";
}

/// Why a robot file cannot hold what is not geometry.
std::string_view reason(RobotFileFormat format) {
  return format == RobotFileFormat::urdf ? "as URDF cannot hold it" : "as poses of bodies cannot hold it";
}

std::string omission(const NonGeometricDifference& difference, RobotFileFormat format) {
  if (difference.depends_on_load)
    return phrase(name(difference.kind), "left out, {}: {}; its size depends on {}", reason(format),
                  noun(difference.kind),
                  difference.kind == NonGeometricKind::expansion ? "the temperature" : "the torques");
  const std::string of_joints =
      difference.joints == 0 ? "" : fmt::format(" ({} joint{})", difference.joints, difference.joints == 1 ? "" : "s");
  return phrase(name(difference.kind),
                "left out, {}: {}{}, which moves the tool by {:.3f} mm rms and at most "
                "{:.3f} mm over the measured poses",
                reason(format), noun(difference.kind), of_joints, 1e3 * difference.rms, 1e3 * difference.max);
}

}  // namespace

std::string headline(const ModelPatch& patch) {
  const auto inserted = std::ranges::count_if(patch.changes, &OriginChange::inserted);
  return phrase("model_patch", "{} is your file with the {} of {} joint{} changed{} and every other byte kept.",
                patch.file, patch.format == RobotFileFormat::urdf ? "origins" : "frames", patch.changes.size(),
                patch.changes.size() == 1 ? "" : "s", inserted ? fmt::format(" ({} added)", inserted) : "");
}

std::vector<std::string> remarks(const ModelPatch& patch) {
  std::vector<std::string> sentences;
  if (patch.offsets == EncoderOffsets::separate)
    sentences.push_back(phrase("offsets_separate",
                               "encoder offsets are not in the {}: add those of {} to the joint positions, or to the "
                               "zeros of the controller",
                               patch.format == RobotFileFormat::urdf ? "origins" : "frames",
                               patch.format == RobotFileFormat::urdf ? "joint_origins.yaml" : "joint_offsets.yaml"));
  sentences.push_back(phrase("placement", "base and tool are in placement.toml, not in the robot's model"));
  for (const NonGeometricDifference& difference : patch.omitted)
    sentences.push_back(omission(difference, patch.format));
  if (patch.omitted.size() > 1)
    sentences.push_back(phrase("omitted_together", "all that is left out: {:.3f} mm rms, at most {:.3f} mm",
                               1e3 * patch.omitted_rms, 1e3 * patch.omitted_max));
  if (!patch.omitted.empty())
    sentences.push_back(phrase("geometry_alone",
                               "part of that could be taken up by the frames: --model geometry finds the best model "
                               "without it, which the file holds completely"));
  return sentences;
}

}  // namespace kinfer::words
