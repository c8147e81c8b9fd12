// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "kinfer/base/expect.hpp"
#include "kinfer/words/findings/finding_words.hpp"
#include "kinfer/words/language.hpp"

namespace kinfer::words {
namespace {

std::string_view unit_name(std::string_view unit) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> names{
      {{"mm", "millimetres"}, {"m", "metres"}, {"in", "inches"}, {"deg", "degrees"}, {"rad", "radians"}}};
  return std::ranges::find(names, unit, &std::pair<std::string_view, std::string_view>::first)->second;
}

/// Of one joint, of all joint positions ("joints"), or of the measured positions.
std::string wrong_unit(const Finding& f) {
  const std::string_view unit = unit_name(f.values.text("unit")), read_as = unit_name(f.values.text("read_as"));
  if (f.values.has("joint"))
    return phrase(name(f.kind), "{} is in {}, but was read as {}", f.values.text("joint"), unit, read_as);
  if (f.kind == FindingKind::length_unit)
    return phrase(name(f.kind), "the measured positions are {}, but were read as {}", unit, read_as);
  return phrase(name(f.kind), "the joint positions are {}, but were read as {}", unit, read_as);
}
std::string wrong_unit_remedy(const Finding& f) {
  const std::string& unit = f.values.text("unit");
  if (f.values.has("joint"))
    return phrase(name(f.kind), "write its unit into the header: q{}[{}]", f.values.count("column"), unit);
  if (f.kind != FindingKind::length_unit)
    return phrase(name(f.kind), "write the unit into the header: q1[{0}], q2[{0}], ...", unit);
  if (unit == "in") return phrase(name(f.kind), "convert them: kinfer knows m, mm and um");
  return phrase(name(f.kind), "write the unit into the header: x[{0}], y[{0}], z[{0}]", unit);
}

std::string wrong_sign(const Finding& f) {
  return phrase(name(f.kind), "{} counts in the other sense than the robot file says", f.values.text("joint"));
}
std::string wrong_sign_remedy(const Finding& f) {
  return phrase(name(f.kind), "give {} gain = {:g} in the robot file", f.values.text("joint"), f.values.number("gain"));
}

std::string joint_offset(const Finding& f) {
  return phrase(name(f.kind), "{} is {:.0f} deg off its zero in the robot file", f.values.text("joint"),
                value_in_deg(f, "offset_rad"));
}
std::string joint_offset_remedy(const Finding& f) {
  return phrase(name(f.kind), "add {:.0f} deg to the zero position (theta) of {} in the robot file",
                value_in_deg(f, "offset_rad"), f.values.text("joint"));
}

std::string columns_swapped(const Finding& f) {
  const std::vector<std::string>& joints = f.values.texts("joints");
  return phrase(name(f.kind), "the joint positions of {} and {} are exchanged", joints.at(0), joints.at(1));
}
std::string columns_swapped_remedy(const Finding& f) {
  const std::vector<int>& columns = f.values.counts("columns");
  return phrase(name(f.kind), "exchange the headers of q{} and q{}", columns.at(0), columns.at(1));
}

std::string joint_coupled(const Finding& f) {
  return phrase(name(f.kind), "{} moves {} {}: a belt or a parallel linkage couples them", f.values.text("joint"),
                f.values.count("factor") > 0 ? "with" : "against", f.values.text("follows"));
}
std::string joint_coupled_remedy(const Finding& f) {
  return phrase(name(f.kind), "give {} coupling = {{ {} = {} }} in the robot file", f.values.text("joint"),
                f.values.text("follows"), f.values.count("factor"));
}

std::string mirrored(const Finding& f) {
  return phrase(name(f.kind), "the measured positions are a mirror image: their axes are not right-handed");
}
std::string mirrored_remedy(const Finding& f) {
  return phrase(name(f.kind), "change the sign of one of x, y, z, or exchange two of them");
}

std::string robot_length_unit(const Finding& f) {
  return phrase(name(f.kind), "the robot reaches {:g} m by its file", f.values.number("reach_m"));
}
std::string robot_length_unit_remedy(const Finding& f) {
  return phrase(name(f.kind), "check units = {{ length = ... }} in the robot file");
}

/// A convention of quaternions: its name in the finding's values, how they are to be read, and what to change.
struct QuaternionWords {
  std::string_view convention, read, remedy;
};
constexpr std::array quaternion_words{
    QuaternionWords{"inverse", "inverted: they turn world coordinates into the tool's",
                    "write the inverse rotations (qx, qy, qz negated)"},
    QuaternionWords{"scalar_last", "in the order x, y, z, w", "rename the columns: qx, qy, qz, qw"},
    QuaternionWords{"mirrored_x", "left-handed: their axes are mirrored in x", "change the signs of qy and qz"},
    QuaternionWords{"mirrored_y", "left-handed: their axes are mirrored in y", "change the signs of qx and qz"},
    QuaternionWords{"mirrored_z", "left-handed: their axes are mirrored in z", "change the signs of qx and qy"}};

const QuaternionWords& words_of_quaternions(const Finding& f) {
  const auto at = std::ranges::find(quaternion_words, f.values.text("quaternions"), &QuaternionWords::convention);
  KINFER_EXPECT(at != quaternion_words.end());
  return *at;
}

std::string orientation_convention(const Finding& f) {
  if (!f.values.has("remaining_rad"))
    return phrase(name(f.kind),
                  "the orientations disagree with the joints by {:.0f} deg, and no other convention that was tried "
                  "explains them",
                  value_in_deg(f, "disagreement_rad"));
  const std::string read = f.values.has("euler")
                               ? fmt::format("as {} angles in {}", f.values.text("euler"), f.values.text("unit"))
                               : std::string(words_of_quaternions(f).read);
  return phrase(name(f.kind),
                "the orientations disagree with the joints by {:.0f} deg; they agree to {:.2f} deg when read {}",
                value_in_deg(f, "disagreement_rad"), value_in_deg(f, "remaining_rad"), read);
}
std::string orientation_convention_remedy(const Finding& f) {
  if (!f.values.has("remaining_rad")) return phrase(name(f.kind), "check their order, sense and unit");
  if (f.values.has("euler"))
    return phrase(name(f.kind), "write euler = \"{}\" into the column map, and rx, ry, rz in [{}]",
                  f.values.text("euler"), f.values.text("unit"));
  return phrase(name(f.kind), "{}", words_of_quaternions(f).remedy);
}

constexpr std::array words_of_conventions{
    FindingWords{FindingKind::degrees_for_radians, wrong_unit, wrong_unit_remedy},
    FindingWords{FindingKind::radians_for_degrees, wrong_unit, wrong_unit_remedy},
    FindingWords{FindingKind::length_unit, wrong_unit, wrong_unit_remedy},
    FindingWords{FindingKind::wrong_sign, wrong_sign, wrong_sign_remedy},
    FindingWords{FindingKind::joint_offset, joint_offset, joint_offset_remedy},
    FindingWords{FindingKind::columns_swapped, columns_swapped, columns_swapped_remedy},
    FindingWords{FindingKind::joint_coupled, joint_coupled, joint_coupled_remedy},
    FindingWords{FindingKind::mirrored, mirrored, mirrored_remedy},
    FindingWords{FindingKind::robot_length_unit, robot_length_unit, robot_length_unit_remedy},
    FindingWords{FindingKind::orientation_convention, orientation_convention, orientation_convention_remedy}};

}  // namespace

std::span<const FindingWords> convention_words() {
  return words_of_conventions;
}

}  // namespace kinfer::words
