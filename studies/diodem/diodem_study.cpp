// SPDX-License-Identifier: Apache-2.0
// A real chain of five segments, moved by hand: identified from its INS alone, compared with an optical reference.
// Arguments: the folder of a trial with rigid.csv, nonrigid.csv and optical.csv; optionally one log and its root.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/geometry/statistics.hpp"
#include "kinfer/identify/pipeline.hpp"
#include "kinfer/io/recording/ins_csv.hpp"
#include "kinfer/words/identification/verdict.hpp"
#include "studies/studies.hpp"
#include "studies/support/optical_truth.hpp"

namespace kinfer::study::diodem_study {
using namespace identify;
namespace {

constexpr double length_of_segment_4 = 0.2706, length_of_segments_2_and_3 = 0.5782;  // [m] by the cameras, to 1-2 mm

/// A joint with the segment of the smaller number as its parent.
JointEstimate outward(JointEstimate joint) {
  if (joint.parent < joint.child) return joint;
  std::swap(joint.parent, joint.child);
  std::swap(joint.axis_in_parent, joint.axis_in_child);
  std::swap(joint.point_in_parent, joint.point_in_child);
  std::swap(joint.sd.axis_in_parent, joint.sd.axis_in_child);
  std::swap(joint.sd.point_in_parent, joint.sd.point_in_child);
  return joint;
}

JointEstimate joint_between(const Identification& found, const std::string& parent, const std::string& child) {
  for (const JointEstimate& joint : found.joints)
    if (const JointEstimate ordered = outward(joint); ordered.parent == parent && ordered.child == child)
      return ordered;
  return {};
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return Angle::rad(std::asin(std::min(1.0, a.cross(b).norm()))).deg();
}

struct Length {
  double metres = 0.0, sd = 0.0;
};

double largest(const std::array<double, 2>& sd) {
  return std::max(sd[0], sd[1]);
}

/// Joint 12 to joint 34 along the axis of joint 23: the split between both segments is unobservable, their sum is not.
Length segments_2_and_3(const Identification& found) {
  const JointEstimate j12 = joint_between(found, "seg1", "seg2"), j23 = joint_between(found, "seg2", "seg3"),
                      j34 = joint_between(found, "seg3", "seg4");
  const Vec3 &a = j23.axis_in_child, &b = j34.axis_in_parent, between = j34.point_in_parent - j23.point_in_child;
  const double in_2 = (j23.point_in_parent - j12.point_in_child).dot(j23.axis_in_parent);
  const double c = a.dot(b), in_3 = (between.dot(a) - c * between.dot(b)) / (1.0 - c * c);  // foot on line 34
  return {std::abs(in_2 + in_3),
          std::hypot(largest(j12.sd.point_in_child), j23.sd.along_axis, largest(j34.sd.point_in_parent))};
}

void print(const char* name, const Length& length, double truth) {
  fmt::print("  {:<15} {:6.1f} mm, sd {:4.1f}; truth {:.1f}; actual/predicted {:5.2f}\n", name, 1e3 * length.metres,
             1e3 * length.sd, 1e3 * truth, (length.metres - truth) / length.sd);
}

void print_comparison(const Identification& found, const OpticalLog& optical, const OpticalAlignment& alignment) {
  std::vector<double> errors;
  for (const auto& [parent, child] : {std::pair{"seg2", "seg3"}, {"seg3", "seg4"}, {"seg4", "seg5"}}) {
    const JointEstimate joint = joint_between(found, parent, child);
    const OpticalJoint truth = optical_joint(optical, alignment, parent, child);
    const double error_in_parent = degrees_between(joint.axis_in_parent, truth.in_parent),
                 error_in_child = degrees_between(joint.axis_in_child, truth.in_child);
    errors.insert(errors.end(), {error_in_parent, error_in_child});
    const auto deg = [](const std::array<double, 2>& sd) { return Angle::rad(std::hypot(sd[0], sd[1])).deg(); };
    fmt::print(
        "  revolute joint {}-{}: axis errors {:.2f} and {:.2f} deg (sd {:.2f}, {:.2f}); optical axis deviation {:.2f} "
        "deg\n",
        parent, child, error_in_parent, error_in_child, deg(joint.sd.axis_in_parent), deg(joint.sd.axis_in_child),
        Angle::rad(truth.axis_deviation).deg());
  }
  fmt::print("  axes: median {:.2f}, worst {:.2f} deg; joint seg1-seg2 is {}\n", median(errors),
             *std::ranges::max_element(errors), name(joint_between(found, "seg1", "seg2").type));
  for (const LinkEstimate& link : found.links)
    if (link.segment == "seg4") print("segment 4", {link.length, link.sd}, length_of_segment_4);
  print("segments 2 + 3", segments_2_and_3(found), length_of_segments_2_and_3);
  fmt::print("  {}\n", words::identification_verdict(found));
}

void run(const std::string& folder, const std::string& log, const std::string& root) {
  const auto recording = read_ins_csv(folder + "/" + log + ".csv");
  const auto optical = read_optical(folder + "/optical.csv", {"seg1", "seg2", "seg3", "seg4", "seg5"});
  if (!recording || !optical) {
    fmt::print("{}\n", recording ? optical.error().what : recording.error().what);
    return;
  }
  const OpticalAlignment alignment = aligned(*optical, *recording);
  fmt::print("{} from {}: the cameras' clock is {:.0f} ms behind; rms differences of angular velocity", log, root,
             1e3 * alignment.late);
  for (const auto& [segment, rms] : alignment.rms) fmt::print(" {:.3f}", rms);
  fmt::print(" rad/s\n");
  const auto found = identify_machine(*recording, {.root = root}, Rng(1));
  if (!found)
    fmt::print("  {}\n", found.error().what);
  else
    print_comparison(*found, *optical, alignment);
}

}  // namespace
}  // namespace kinfer::study::diodem_study

int kinfer::study::run_diodem(int argc, char** argv) {
  if (argc != 2 && argc != 4) {
    fmt::print("usage: ./dev study diodem FOLDER [LOG ROOT]\n");
    return 1;
  }
  if (argc == 4) {
    diodem_study::run(argv[1], argv[2], argv[3]);
    return 0;
  }
  for (const char* log : {"rigid", "nonrigid"})
    for (const char* root : {"seg5", "seg1"}) diodem_study::run(argv[1], log, root);
  return 0;
}
