// SPDX-License-Identifier: Apache-2.0
#include "kinfer/words/identification/notes.hpp"

#include "kinfer/base/angle.hpp"
#include "kinfer/words/findings/findings.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string unsafe_order(const FactValues& v) {
  return phrase("unsafe_order",
                "the order of the segments is not safe: another tree fits almost as well (margin {:.2f}, safe is {})",
                v.number("margin"), v.number("safe_margin"));
}

std::string unexplained_motion(const FactValues& v) {
  return phrase("unexplained_motion",
                "the chain leaves {:.1f} times its noise of the specific force of {} unexplained ({:.3f} m/s²) and "
                "{:.1f} times of its angular velocity: a compliant mount, play in a joint, a loop, a sensor that was "
                "remounted, or a wrong tree; the standard deviations have grown with it",
                v.number("force_ratio"), v.text("sensor"), v.number("force_noise"), v.number("rate_ratio"));
}

std::string relaxed_joint(const FactValues& v) {
  return phrase("relaxed_joint",
                "the joint {}-{} is not strictly revolute: its axis deviates by {:.1f} degrees (rms), due to play in "
                "the bearing, a flexible segment or a compliant mount; it was relaxed to a spherical joint, and the "
                "axis stated is the mean",
                v.text("parent"), v.text("child"), Angle::rad(v.number("axis_deviation")).deg());
}

}  // namespace

std::string note_sentence(const IdentificationNote& note) {
  const FactValues& v = note.values;
  switch (note.kind) {
    case IdentificationNoteKind::several_signals:
      return phrase("several_signals",
                    "the chain to {} uses {} signals, so it is no revolute joint; its axis is the one nearest to it",
                    v.text("child"), v.count("signals"));
    case IdentificationNoteKind::prismatic_joint:
      return phrase("prismatic_joint", "{} slides on {}", v.text("child"), v.text("parent"));
    case IdentificationNoteKind::universal_joint:
      return phrase("universal_joint", "{} rotates on {} about two axes, one fixed in each", v.text("child"),
                    v.text("parent"));
    case IdentificationNoteKind::spherical_joint:
      return phrase("spherical_joint", "{} rotates on {} about every axis through one point", v.text("child"),
                    v.text("parent"));
    case IdentificationNoteKind::no_relative_motion:
      return phrase("no_relative_motion",
                    "{} never moves relative to {}: on the same segment, or the joint between them is not excited",
                    v.text("child"), v.text("parent"));
    case IdentificationNoteKind::unsafe_order:
      return unsafe_order(v);
    case IdentificationNoteKind::phases_disagree:
      return phrase("phases_disagree",
                    "the phases in which the segments move give another order: joints that move together, a moving "
                    "base or a swaying machine; the pairwise fits are used");
    case IdentificationNoteKind::refinement_failed:
      return phrase("refinement_failed", "{}; the geometry is that of the search", v.text("reason"));
    case IdentificationNoteKind::unexplained_motion:
      return unexplained_motion(v);
    case IdentificationNoteKind::limited_passband:
      return phrase("limited_passband",
                    "faster motion is not that of a rigid chain: the geometry comes from the motion below {:.1f} Hz, "
                    "and its standard deviations contain what a wider band would change",
                    v.number("cutoff"));
    case IdentificationNoteKind::assumed_force_sign:
      return phrase("assumed_force_sign",
                    "assumed: accelerometers read +g upwards at rest; without magnetometer nothing in a log tells, and "
                    "if they read -g, all lever arms are mirrored (a column map can say sign force = -1)");
    case IdentificationNoteKind::relaxed_joint:
      break;
  }
  return relaxed_joint(v);
}

std::vector<std::string> note_sentences(const Identification& result) {
  std::vector<std::string> sentences;
  for (const IdentificationNote& note : result.notes) sentences.push_back(note_sentence(note));
  for (const Finding& finding : result.findings) {
    const std::string remedy = suggestion(finding);
    sentences.push_back(remedy.empty() ? sentence(finding) : sentence(finding) + ": " + remedy);
  }
  return sentences;
}

}  // namespace kinfer::words
