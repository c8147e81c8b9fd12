// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/calibration/checks.hpp"

#include <cmath>

#include "kinfer/words/language.hpp"
#include "kinfer/words/status.hpp"

namespace kinfer::words {
namespace {

std::string mm_text(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}

std::string significant_changes(const std::vector<ParameterChange>& changes) {
  std::string text;
  for (const ParameterChange& c : changes)
    if (c.significant) text += fmt::format("{}{} ({:.1f} sigma)", text.empty() ? "" : ", ", c.name, std::abs(c.sigmas));
  return text;
}

}  // namespace

std::string verdict(const Verification& v) {
  const std::string_view id = name(v.result);
  const std::string figures = fmt::format("the tool is {} off on average and {} at worst", mm_text(v.unmodified.mean),
                                          mm_text(v.unmodified.max));
  switch (v.result) {
    case VerificationResult::valid:
      if (!v.noise_is_known)
        return phrase("valid_noise_unknown",
                      "Base and tool have not moved: {}. Whether the robot has changed cannot be told, because "
                      "[instrument] states no noise.",
                      figures);
      return phrase(id, "Still good: {}.", figures);
    case VerificationResult::frames_moved:
      return phrase(id,
                    "Not good as it stands: {}; with base and tool refitted {} on average, so the instrument or the "
                    "tool was moved rather than the robot changed.",
                    figures, mm_text(v.frames_refitted.mean));
    case VerificationResult::robot_changed:
      return phrase(id,
                    "Not good any more: {}, more than the instrument explains, and refitting base and tool does not "
                    "cure it ({}). Calibrate again.",
                    figures, mm_text(v.frames_refitted.mean));
    case VerificationResult::moved_or_changed:
      return phrase(id,
                    "Not good as it stands: {}, more than the instrument explains. The points are too few to tell "
                    "whether the instrument, the tool or the robot has moved: measure more poses.",
                    figures);
  }
  return "";
}

std::string verdict(const CalibrationComparison& c) {
  const std::string tool = fmt::format("the tool differs by {:.3f} mm rms and {:.3f} mm at worst over the joint ranges",
                                       1e3 * c.tool_rms, 1e3 * c.tool_worst);
  return c.changed ? phrase("changed", "Changed: {}; {}.", significant_changes(c.parameters), tool)
                   : phrase("unchanged", "No change beyond chance in {} numbers; {}.", c.parameters.size(), tool);
}

std::string summary(const CompensationSummary& summary) {
  return phrase("compensation", "{} of {} rows are compensated; the corrected model leaves {:.6f} mm at most",
                static_cast<std::size_t>(summary.rows) - summary.unreached.size(), summary.rows,
                1e3 * summary.worst_residual);
}

std::string unreached_row(int row, const CompensatedJoints& joints) {
  return phrase("unreached_row", "row {}: {}; {:.4f} mm and {:.4f} deg are left", row, sentence(joints.status),
                1e3 * joints.residual, joints.residual_angle / degree);
}

std::string compensation_frames_note() {
  return phrase("compensation_frames",
                "the corrected base is far from the nominal one, so it shows where the instrument stood: compared with "
                "the nominal base and tool (--frames world compares as given)");
}

std::string description(Criterion criterion) {
  const std::string_view id = name(criterion);
  switch (criterion) {
    case Criterion::tool:
      return phrase(id, "tool error over the workspace (I-optimal)");
    case Criterion::worst:
      return phrase(id, "worst tool error over the workspace (G-optimal)");
    case Criterion::d:
      return phrase(id, "D-optimal");
    case Criterion::a:
      return phrase(id, "A-optimal");
    case Criterion::e:
      return phrase(id, "E-optimal");
  }
  return "";
}

std::string unused_accuracies(std::span<const std::string_view> keys) {
  return phrase("unused_accuracies", "[instrument] states {}, but nothing that {} was measured", fmt::join(keys, ", "),
                keys.size() == 1 ? "it concerns" : "they concern");
}

}  // namespace kinfer::words
