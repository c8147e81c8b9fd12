// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/evidence/identification/unobservable_limit.hpp"
#include "kinfer/report/identify/sections.hpp"
#include "kinfer/report/identify/unobservable.hpp"
#include "kinfer/report/parts/units.hpp"

namespace kinfer::report {
namespace {

using html::Cell;

double across(const std::array<double, 2>& sd) {
  return std::hypot(sd[0], sd[1]);
}

Cell vector_cell(const Vec3& v, double scale, int decimals) {
  return {fmt::format("{}&ensp;{}&ensp;{}", html::fixed(scale * v.x(), decimals), html::fixed(scale * v.y(), decimals),
                      html::fixed(scale * v.z(), decimals)),
          fmt::format("{:.12g} {:.12g} {:.12g}", scale * v.x(), scale * v.y(), scale * v.z()), html::CellKind::number};
}

Cell axis_cell(const JointEstimate& joint, const Vec3& axis, const std::array<double, 2>& sd) {
  if (joint.type == EstimatedJointType::spherical) return {"–", "", html::CellKind::number};
  if (!is_axis_known(joint, sd)) return html::undetermined_cell("unknown");
  return vector_cell(axis, 1.0, 5);
}

Cell plus_minus(double sd, double scale, int decimals) {
  if (!(sd < unobservable_sd)) return html::undetermined_cell("not determinable");
  return html::number(sd, scale, decimals);
}

/// A point that is known in some directions only is shown in brackets: the others are a choice, not a measurement.
Cell point_cell(const Vec3& point, double sd, bool known) {
  if (!known) return html::undetermined_cell("unknown");
  Cell cell = vector_cell(point, mm, 1);
  if (!(sd < unobservable_sd)) cell.shown = "<span class=\"note\">(" + cell.shown + ")</span>";
  return cell;
}

/// A joint's axis line in the frame of one of its sensors.
struct JointSide {
  const std::string& sensor;
  const Vec3 &axis, &point;
  const std::array<double, 2>&axis_sd, &point_sd;
  const std::vector<Vec3>& unobservable;
};

std::vector<Cell> joint_row(const JointEstimate& joint, const JointSide& side, const std::string& head,
                            const std::string& type) {
  return {html::text(head),
          html::text(type),
          html::text(side.sensor),
          axis_cell(joint, side.axis, side.axis_sd),
          plus_minus(across(side.axis_sd), mrad, 2),
          point_cell(side.point, across(side.point_sd), is_point_known(side.point_sd, side.unobservable)),
          plus_minus(across(side.point_sd), mm, 1)};
}

std::string joint_table(const IdentificationEvidence& e) {
  html::Table table{.name = "joints",
                    .caption = "Joints in the frames of the INS on both sides; point [mm]",
                    .head = {"Joint", "type", "seen by", "axis (x y z)", "± [mrad]", "point [mm] (x y z)", "± [mm]"},
                    .rows = {}};
  for (const JointRecord& record : e.joints) {
    const JointEstimate& j = record.estimate;
    const JointSide parent{j.parent,
                           j.axis_in_parent,
                           j.point_in_parent,
                           j.sd.axis_in_parent,
                           j.sd.point_in_parent,
                           j.unobservable_in_parent};
    const JointSide child{
        j.child, j.axis_in_child, j.point_in_child, j.sd.axis_in_child, j.sd.point_in_child, j.unobservable_in_child};
    table.rows.push_back(joint_row(j, parent, joint_label(j), std::string(name(j.type))));
    table.rows.push_back(joint_row(j, child, "", ""));
  }
  return html::table(table);
}

/// "revolute, 72.3 %"; certainty is never rounded to.
std::string type_text(const JointEstimate& joint) {
  std::string type(name(joint.type));
  if (!joint.type_probabilities) return type;
  const double percent = 100.0 * type_probability(joint);
  return percent > 99.9 ? type + ", > 99.9 %" : fmt::format("{}, {:.1f} %", type, percent);
}

/// Which joints may be used, how certain their types are, and what speaks against them.
std::string verdict_table(const IdentificationEvidence& e) {
  html::Table table{
      .name = "joint-verdicts", .caption = "Verdicts", .head = {"Joint", "verdict", "type", "why"}, .rows = {}};
  for (const JointRecord& joint : e.joints) {
    std::string usability(name(joint.usability));
    std::ranges::replace(usability, '_', ' ');
    std::string why;
    for (const JointDoubtRecord& doubt : joint.doubts) why += (why.empty() ? "" : "; ") + doubt.sentence;
    table.rows.push_back({html::text(joint_label(joint.estimate)), html::text(usability),
                          html::text(type_text(joint.estimate)), html::text(why)});
  }
  return table.rows.empty() ? "" : html::table(table);
}

/// The sensor's axis nearest to the line between the two pins, and the angle between them: what a mounting drawing
/// needs.
Cell pin_line_cell(const LinkEstimate& link) {
  Eigen::Index nearest = 0;
  const double cosine = link.pin->direction.cwiseAbs().maxCoeff(&nearest);
  const double angle = std::acos(std::min(cosine, 1.0));
  const std::string sign = link.pin->direction[nearest] < 0.0 ? "−" : "";
  return {fmt::format("{}° ± {}° from {}{}", html::fixed(angle / degree, 2),
                      html::fixed(link.pin->direction_sd / degree, 2), sign, "xyz"[nearest]),
          fmt::format("{:.12g}", angle / degree), html::CellKind::text};
}

std::vector<Cell> link_row(const LinkEstimate& link) {
  const Cell none = html::text("–");
  return {html::text(link.segment),
          html::text(link.from),
          html::text(link.to),
          link.pin ? html::number(link.pin->distance, mm, 1) : none,
          link.pin ? plus_minus(link.pin->sd, mm, 1) : none,
          link.pin ? pin_line_cell(link) : none,
          std::isfinite(link.axis_angle) ? html::number(link.axis_angle, 1.0 / degree, 2) : none,
          html::number(link.length, mm, 1),
          plus_minus(link.sd, mm, 1)};
}

std::string link_table(const IdentificationEvidence& e) {
  html::Table table{
      .name = "links",
      .caption =
          "Between the two axes of a segment [mm]: from pin to pin where they are nearly parallel "
          "(across the mean axis, level with the sensor), their angle, and their shortest distance",
      .head = {"Segment", "from", "to", "pin to pin", "±", "line of the pins", "axes' angle [°]", "shortest", "±"},
      .rows = {}};
  for (const LinkEstimate& link : e.links) table.rows.push_back(link_row(link));
  return table.rows.empty() ? "" : html::table(table);
}

/// A number without a standard deviation is a choice of the convention.
Cell dh_cell(double value, double sd, double scale, int decimals) {
  const std::string exact = fmt::format("{:.12g}", scale * value);
  if (!(sd < unobservable_sd))
    return {html::undetermined_cell("not determinable").shown, exact, html::CellKind::number};
  std::string shown = html::fixed(scale * value, decimals);
  if (sd > 0.0) shown += fmt::format(" <small>± {}</small>", html::fixed(scale * sd, std::max(1, decimals - 1)));
  return {shown, exact, html::CellKind::number};
}

std::vector<Cell> dh_row(const DhRowEstimate& row) {
  const auto angle = [&](double DhNumbers::*k) { return dh_cell(row.row.*k, row.sd.*k, 1.0 / degree, 3); };
  const auto length = [&](double DhNumbers::*k) { return dh_cell(row.row.*k, row.sd.*k, mm, 1); };
  return {html::text(row.segment),
          angle(&DhNumbers::theta),
          length(&DhNumbers::d),
          length(&DhNumbers::a),
          angle(&DhNumbers::alpha),
          angle(&DhNumbers::beta),
          html::text(row.theta_variable.empty() ? row.d_variable : row.theta_variable)};
}

}  // namespace

html::Section joints_section(const IdentificationEvidence& e) {
  return {"joints-section", "What was found",
          "Every joint as a line in space, in the frame of the INS on either side. Both points are the same physical "
          "point. A point in brackets is known in some directions only; the others are a choice of the convention.",
          verdict_table(e) + joint_table(e) + link_table(e)};
}

html::Section dh_section(const IdentificationEvidence& e) {
  html::Table table{.name = "dh",
                    .caption = "The chain as DH rows RotZ(theta) TransZ(d) TransX(a) RotX(alpha) RotY(beta)",
                    .head = {"Towards", "theta [°]", "d [mm]", "a [mm]", "alpha [°]", "beta [°]", "variable"},
                    .rows = {}};
  for (const DhRowEstimate& row : e.dh) table.rows.push_back(dh_row(row));
  return {
      "dh-section", "DH table",
      "The rows lead from one INS to the next: to the joint's axis, across the joint (once for each of its axes), to "
      "the next INS. A number without "
      "± is a choice of the convention. <i>Not determinable</i>: unobservable from this recording.",
      html::table(table)};
}

}  // namespace kinfer::report
