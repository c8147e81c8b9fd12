// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/identification_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/evidence/identification/unobservable_limit.hpp"
#include "kinfer/words/identification/joint_verdict.hpp"
#include "kinfer/words/identification/notes.hpp"
#include "kinfer/words/identification/unobservable.hpp"
#include "kinfer/words/identification/verdict.hpp"

namespace kinfer::cli {
namespace {

/// Paper 1's table 3, and the margin of the spanning tree.
std::string order_table(const OrderEvidence& order) {
  std::string text = fmt::format("{:<22}", "who moves when [s]");
  for (const std::string& sensor : order.sensors) text += fmt::format(" {:>8}", sensor);
  text += "\n";
  for (const PhaseEvidence& phase : order.phases) {
    text += fmt::format("  {:>8.2f} .. {:<8.2f}", phase.begin, phase.end);
    for (const bool moves : phase.moves) text += fmt::format(" {:>8}", moves ? 1 : 0);
    text += "\n";
  }
  text += fmt::format("{:<22}", "  rank");
  for (const int rank : order.rank) text += fmt::format(" {:>8}", rank);
  return text + fmt::format("\nspanning tree of pairwise fits: margin {}; the two {}\n\n",
                            order.margin ? fmt::format("{:.2f}", *order.margin) : "none, there is no other tree",
                            order.phases_agree ? "agree" : "do not agree");
}

/// Components with a fixed number of decimals; no negative zero.
std::string vector_text(const Vec3& v, double scale, int width, int decimals) {
  const double unit = std::pow(10.0, decimals);
  std::string text;
  for (Eigen::Index k = 0; k < 3; ++k)
    text += fmt::format("{:{}.{}f}", std::round(unit * scale * v[k]) / unit + 0.0, width, decimals);
  return text;
}

std::string known_text(bool known, const Vec3& v, double scale, int width, int decimals) {
  return known ? vector_text(v, scale, width, decimals) : "unknown";
}

/// Combined standard deviation of two directions; "unknown" if not determined by the data.
std::string deviation_text(const std::array<double, 2>& sd, double scale, int decimals) {
  const double both = std::hypot(sd[0], sd[1]);
  return both < unobservable_sd ? fmt::format("{:.{}f}", scale * both, decimals) : "unknown";
}

/// Unobservable quantities of each joint and their remedies.
std::string unobservable_list(const std::vector<JointEstimate>& joints) {
  std::string text;
  for (const JointEstimate& joint : joints)
    for (const Unobservable& u : joint.unobservable)
      if (u.kind != UnobservableKind::point_on_axis)  // true of every revolute joint
        text += fmt::format("  - {}: {}: {}\n", joint_name(joint), words::unobservable_text(u, joint),
                            words::remedy_text(u));
  return text.empty() ? "" : "Unobservable in this recording:\n" + text + "\n";
}

std::string joint_table(const std::vector<JointEstimate>& joints) {
  std::string text = fmt::format("{:<16} {:<10} {:<8} {:>24} {:>27} {:>16} {:>10}\n", "joint", "type", "seen by",
                                 "axis", "point [mm]", "sd axis [mrad]", "sd [mm]");
  for (const JointEstimate& j : joints) {
    const auto line = [&](const std::string& head, std::string_view type, const std::string& sensor, const Vec3& axis,
                          const Vec3& point, const std::array<double, 2>& axis_sd,
                          const std::array<double, 2>& point_sd, const std::vector<Vec3>& unobservable) {
      text += fmt::format("{:<16} {:<10} {:<8} {:>24} {:>27} {:>16} {:>10}\n", head, type, sensor,
                          known_text(is_axis_known(j, axis_sd), axis, 1.0, 8, 4),
                          known_text(is_point_known(point_sd, unobservable), point, 1e3, 9, 1),
                          deviation_text(axis_sd, 1e3, 2), deviation_text(point_sd, 1e3, 1));
    };
    line(joint_name(j), name(j.type), j.parent, j.axis_in_parent, j.point_in_parent, j.sd.axis_in_parent,
         j.sd.point_in_parent, j.unobservable_in_parent);
    line("", "", j.child, j.axis_in_child, j.point_in_child, j.sd.axis_in_child, j.sd.point_in_child,
         j.unobservable_in_child);
  }
  return text + "\n";
}

/// Verdict on each joint, with what speaks against it.
std::string verdict_list(const std::vector<JointVerdict>& verdicts) {
  std::string text;
  for (const JointVerdict& verdict : verdicts) {
    text += fmt::format("{:<16} {}", verdict.joint, words::joint_usability_text(verdict.usability));
    for (std::size_t i = 0; i < verdict.doubts.size(); ++i)
      text += (i == 0 ? ": " : "; ") + words::doubt_sentence(verdict.doubts[i]);
    text += "\n";
  }
  return text.empty() ? "" : text + "\n";
}

std::string fit_table(const std::vector<LinkEvidence>& searches) {
  if (searches.empty()) return "";
  std::string text = fmt::format("{:<12} {:>12} {:>12} {:>12} {:>14} {:>12}\n", "J_RMSE", "accel. m/s2", "orient. rad",
                                 "total", "not fitted", "evaluations");
  for (const LinkEvidence& s : searches)
    text += fmt::format("{:<12} {:>12.5f} {:>12.5f} {:>12.5f} {:>14.5f} {:>12}\n", s.segment, s.fitted.acceleration,
                        s.fitted.orientation, s.fitted.total, s.holdout.total, s.evaluations);
  return text + "\n";
}

std::string length_text(double length, double sd) {
  return sd < unobservable_sd ? fmt::format("{:.1f} mm (sd {:.1f} mm)", 1e3 * length, 1e3 * sd) : "unknown";
}

/// The angle between the line of the pins and the nearest axis of the segment's sensor: how the sensor sits on it.
std::string pin_line_text(const PinDistance& pin) {
  Eigen::Index nearest = 0;
  const double cosine = pin.direction.cwiseAbs().maxCoeff(&nearest);
  return fmt::format("{:.2f}° (sd {:.2f}°) from the sensor's {}{} axis", std::acos(std::min(1.0, cosine)) / degree,
                     pin.direction_sd / degree, pin.direction[nearest] < 0.0 ? "−" : "", "xyz"[nearest]);
}

/// From pin to pin where the axes are nearly parallel, else the shortest distance.
std::string link_line(const LinkEstimate& link) {
  const std::string ends = fmt::format("link {}: from {} to {}", link.segment, link.from, link.to);
  if (link.pin)
    return fmt::format("{}, pin to pin {}, {}, axes parallel within {:.2f}°\n", ends,
                       length_text(link.pin->distance, link.pin->sd), pin_line_text(*link.pin),
                       link.axis_angle / degree);
  return fmt::format("{}, shortest distance {}\n", ends, length_text(link.length, link.sd));
}

}  // namespace

std::string identification_summary(const Identification& found) {
  std::string text = words::identification_verdict(found) + ".\n\n" + order_table(found.order) +
                     joint_table(found.joints) + verdict_list(found.verdicts);
  for (const LinkEstimate& link : found.links) text += link_line(link);
  for (const PointEstimate& place : found.places)
    text += fmt::format("{} in {}: {} mm (sd {} mm)\n", place.name, place.sensor, vector_text(place.xyz, 1e3, 9, 1),
                        vector_text(place.sd, 1e3, 6, 1));
  if (!found.links.empty()) text += "\n";
  text += fit_table(found.searches) + unobservable_list(found.joints);
  for (const std::string& note : words::note_sentences(found)) text += "  - " + note + "\n";
  if (dof(found.chain) == 0) text += "  - No chain is written, since no joint of it moves\n";
  return text;
}

}  // namespace kinfer::cli
