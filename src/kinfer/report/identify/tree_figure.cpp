// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "kinfer/report/identify/figures.hpp"
#include "kinfer/report/parts/html.hpp"

namespace kinfer::report {
namespace {

constexpr double column_width = 150.0, row_height = 46.0, box_width = 80.0, box_height = 26.0;

struct Corner {
  double x = 0.0, y = 0.0;
};

/// Positions of the segments' boxes: the root on the left, each segment centred beside its children.
class TreeLayout {
 public:
  explicit TreeLayout(const IdentificationEvidence& evidence) : joints_(evidence.joints) { place(evidence.root, 0.0); }

  std::map<std::string, Corner> corners;
  double rows = 0.0, columns = 0.0;

 private:
  double place(const std::string& sensor, double depth) {
    placed_.insert(sensor);
    double first = -1.0, last = -1.0;
    for (const JointRecord& joint : joints_)
      if (joint.estimate.parent == sensor && !placed_.contains(joint.estimate.child)) {
        last = place(joint.estimate.child, depth + 1.0);
        if (first < 0.0) first = last;
      }
    const double y = first < 0.0 ? row_height * rows++ : 0.5 * (first + last);
    corners[sensor] = {column_width * depth, y};
    columns = std::max(columns, depth);
    return y;
  }

  const std::vector<JointRecord>& joints_;
  std::set<std::string> placed_;
};

/// "0.016 m/s²": difference of the accelerations of the common point as measured on both segments.
std::string residual_text(const OrderEvidence& order, const std::string& a, const std::string& b) {
  for (const PairEvidence& pair : order.pairs)
    if ((pair.first == a && pair.second == b) || (pair.first == b && pair.second == a))
      return html::short_number(pair.residual) + " m/s²";
  return "";
}

std::string joint_line(const IdentificationEvidence& evidence, const JointEstimate& joint, const Corner& parent,
                       const Corner& child) {
  const double x = 0.5 * (parent.x + box_width + child.x), y = 0.5 * (parent.y + child.y) + 0.5 * box_height;
  return fmt::format(
      "<path class=\"axis\" d=\"M{} {}L{} {}\"/><text class=\"tx\" x=\"{}\" y=\"{}\">{}</text>"
      "<text class=\"tx\" x=\"{}\" y=\"{}\">{}</text>",
      parent.x + box_width, parent.y + 0.5 * box_height, child.x, child.y + 0.5 * box_height, x, y - 6,
      name(joint.type), x, y + 15, residual_text(evidence.order, joint.parent, joint.child));
}

/// At most ten bytes, cut between characters.
std::string short_name(const std::string& name) {
  if (name.size() <= 10) return name;
  std::size_t end = 9;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
  return name.substr(0, end) + "…";
}

std::string segment_box(const std::string& sensor, const Corner& corner) {
  return fmt::format(
      "<rect class=\"node\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"6\"/><text class=\"tx node\" "
      "x=\"{}\" y=\"{}\">{}</text>",
      corner.x, corner.y, box_width, box_height, corner.x + 0.5 * box_width, corner.y + 17,
      html::escape(short_name(sensor)));
}

}  // namespace

std::string tree_drawing(const IdentificationEvidence& evidence) {
  TreeLayout layout(evidence);
  std::string lines, boxes;
  for (const JointRecord& joint : evidence.joints)
    lines += joint_line(evidence, joint.estimate, layout.corners[joint.estimate.parent],
                        layout.corners[joint.estimate.child]);
  for (const auto& [sensor, corner] : layout.corners) boxes += segment_box(sensor, corner);
  const double width = column_width * layout.columns + box_width;
  return fmt::format(
      "<div class=\"scroll\" tabindex=\"0\"><svg class=\"plot tree\" style=\"min-width:{2:.0f}px;max-width:{0:.0f}px\" "
      "viewBox=\"-4 -4 {0} "
      "{1}\" role=\"img\" aria-label=\"Order of the "
      "segments\">{3}{4}</svg></div>",
      width + 8, row_height * std::max(1.0, layout.rows) - row_height + box_height + 8, 0.8 * width, lines, boxes);
}

}  // namespace kinfer::report
