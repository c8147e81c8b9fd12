// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/joint_verdict.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kinfer/words/language.hpp"

namespace kinfer::words {

std::string joint_usability_text(JointUsability usability) {
  std::string text(name(usability));
  std::ranges::replace(text, '_', ' ');
  return text;
}

namespace {

/// "revolute with 72 %, universal with 28 %"
std::string types_text(const FactValues& v) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < v.texts("types").size(); ++i)
    texts.push_back(fmt::format("{} with {:.0f} %", v.texts("types")[i], 100.0 * v.numbers("probabilities")[i]));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace

std::string doubt_sentence(const JointDoubt& doubt) {
  const FactValues& v = doubt.values;
  switch (doubt.kind) {
    case JointDoubtKind::not_connected:
      return phrase("joint_not_connected",
                    "a joint explains the motion no better than that of recordings shifted in time ({:.1f} nats a row; "
                    "joints of machines gain {:.0f} and more)",
                    v.number("gain"), v.number("needed"));
    case JointDoubtKind::weakly_connected:
      return phrase(
          "joint_weakly_connected",
          "a joint explains little of the motion ({:.1f} nats a row; joints of machines gain {:.0f} and more)",
          v.number("gain"), v.number("needed"));
    case JointDoubtKind::partly_connected:
      return phrase("joint_partly_connected", "the two segments are connected from {:.0f} to {:.0f} s only",
                    v.number("begin"), v.number("end"));
    case JointDoubtKind::changed:
      return phrase("joint_changed", "the two halves of the recording need different joints");
    case JointDoubtKind::beyond_reach:
      return phrase("joint_beyond_reach", "its point is {:.0f} m from {}, beyond the reach of a machine ({:.0f} m)",
                    v.number("distance"), v.text("sensor"), v.number("reach"));
    case JointDoubtKind::not_moved:
      return phrase("joint_not_moved", "it never moved");
    case JointDoubtKind::undetermined:
      return phrase("joint_undetermined", "the recording does not determine where its axis is");
    case JointDoubtKind::unsafe_order:
      return phrase("joint_unsafe_order", "{} and {} may be joined instead (margin {:.2f}, safe is {:.0f})",
                    v.text("first"), v.text("second"), v.number("margin"), v.number("safe_margin"));
    case JointDoubtKind::not_fitted:
      return phrase("joint_not_fitted", "the fit of the whole recording failed: it is known by two sensors alone");
    case JointDoubtKind::unexplained_motion:
      return phrase("joint_unexplained_motion", "the motion of {} is explained to {:.0f} times its noise only",
                    v.text("sensor"), v.number("ratio"));
    case JointDoubtKind::uncertain_type:
      return phrase("joint_uncertain_type", "its type is uncertain: {}", types_text(v));
    case JointDoubtKind::inaccurate:
      break;
  }
  return phrase("joint_inaccurate", "its axis is known to ± {:.1f} mm and ± {:.1f} mrad only",
                1e3 * v.number("line_sd"), 1e3 * v.number("direction_sd"));
}

std::string uncertain_types_sentence(const Identification& result) {
  const double all = probability_of_types(result.joints);
  if (all >= wanted_confidence || result.usability == Usability::do_not_use) return "";
  std::vector<std::string> texts;
  for (const JointVerdict& joint : result.verdicts)
    for (const JointDoubt& doubt : joint.doubts)
      if (doubt.kind == JointDoubtKind::uncertain_type)
        texts.push_back(fmt::format("{} is {}", joint.joint, types_text(doubt.values)));
  if (texts.empty())
    return phrase("uncertain_types", "all joint types are right with {:.0f} % only", std::floor(100.0 * all));
  return phrase("uncertain_joint_types", "joint types are uncertain: {}", fmt::join(texts, "; "));
}

std::string usable_part_sentence(const Identification& result) {
  std::vector<std::string> usable;
  for (const JointVerdict& joint : result.verdicts)
    if ((joint.usability == JointUsability::use || joint.usability == JointUsability::use_with_care) &&
        std::ranges::find(joint.doubts, JointDoubtKind::weakly_connected, &JointDoubt::kind) == joint.doubts.end())
      usable.push_back(joint.usability == JointUsability::use ? joint.joint : joint.joint + " (with care)");
  if (usable.empty() || result.usability != Usability::do_not_use) return "";
  return phrase("usable_part", "of this, {} may be used", fmt::join(usable, ", "));
}

std::vector<std::string> refused_joint_sentences(const Identification& result) {
  std::vector<std::string> sentences;
  for (const JointVerdict& joint : result.verdicts)
    if (joint.usability == JointUsability::do_not_use)
      sentences.push_back(phrase("refused_joint", "{}: {}", joint.joint, doubt_sentence(joint.doubts.front())));
  return sentences;
}

}  // namespace kinfer::words
