// SPDX-License-Identifier: Apache-2.0
#include "kinfer/simulate/machine.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "kinfer/base/expect.hpp"
#include "kinfer/geometry/random.hpp"
#include "kinfer/simulate/machine_files.hpp"

namespace kinfer {
namespace {

using tinyxml2::XMLElement;

constexpr const char* general_excavator = "excavator-general";

std::string text(const Vec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}
std::string text(const Quat& q) {
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z());
}

Vec3 vector_of(const XMLElement& element, const char* attribute, const Vec3& otherwise) {
  const char* written = element.Attribute(attribute);
  if (!written) return otherwise;
  std::istringstream numbers(written);
  Vec3 v;
  numbers >> v.x() >> v.y() >> v.z();
  return v;
}

void randomise_mounting(XMLElement& site, double spread, Rng rng) {
  for (const char* orientation : {"quat", "euler", "xyaxes", "zaxis", "axisangle"}) site.DeleteAttribute(orientation);
  const Vec3 reversed = uniform_vector(rng, -spread, spread);  // z first: machines of a seed stay what they were
  const Vec3 shift = reversed.reverse();
  site.SetAttribute("pos", text(vector_of(site, "pos", Vec3::Zero()) + shift).c_str());
  site.SetAttribute("quat", text(random_orientation(rng)).c_str());
}

void perturb_joint(XMLElement& body, XMLElement& joint, const MachineOptions& options, Rng rng) {
  const Vec3 axis = exp_so3(options.joint_error.rad() * normal_vector(rng)) * vector_of(joint, "axis", Vec3::UnitZ());
  joint.SetAttribute("axis", text(axis.normalized()).c_str());
  body.SetAttribute("pos",
                    text(vector_of(body, "pos", Vec3::Zero()) + options.joint_shift * normal_vector(rng)).c_str());
}

/// Randomises joints and mountings of `body` and its descendants; every body and sensor has a random stream of its own.
void randomise_machine(XMLElement& body, double spread, const MachineOptions& options, Rng rng) {
  if (XMLElement* joint = body.FirstChildElement("joint")) perturb_joint(body, *joint, options, rng.stream(1));
  if (XMLElement* site = body.FirstChildElement("site")) randomise_mounting(*site, spread, rng.stream(2));
  std::uint64_t child_index = 3;
  for (XMLElement* child = body.FirstChildElement("body"); child; child = child->NextSiblingElement("body"))
    randomise_machine(*child, spread, options, rng.stream(child_index++));
}

/// Joints of the platform itself, ahead of its other children: prismatic first, then revolute.
int add_base_joints(XMLElement& platform, Base base) {
  struct BaseJoint {
    const char *name, *type, *axis;
  };
  std::vector<BaseJoint> joints{{"base_heave", "slide", "0 0 1"}};
  if (base == Base::yawing) joints.push_back({"base_yaw", "hinge", "0 0 1"});
  joints.push_back({"base_pitch", "hinge", "0 1 0"});
  joints.push_back({"base_roll", "hinge", "1 0 0"});
  for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint) {  // each becomes the first child
    XMLElement* element = platform.GetDocument()->NewElement("joint");
    element->SetAttribute("name", joint->name);
    element->SetAttribute("type", joint->type);
    element->SetAttribute("axis", joint->axis);
    element->SetAttribute("limited", "false");
    platform.InsertFirstChild(element);
  }
  return static_cast<int>(joints.size());
}

void prepend_zeros(XMLElement& root, int count) {
  XMLElement* key = root.FirstChildElement("keyframe")->FirstChildElement("key");
  std::string qpos;
  for (int i = 0; i < count; ++i) qpos += "0 ";
  key->SetAttribute("qpos", (qpos + key->Attribute("qpos")).c_str());
}

void tilt_platform(XMLElement& platform, Angle slope, Rng rng) {
  const double azimuth = rng.uniform(0.0, 2.0 * std::numbers::pi);
  platform.SetAttribute("quat", text(quat_exp(slope.rad() * Vec3(std::cos(azimuth), std::sin(azimuth), 0.0))).c_str());
}

/// Accelerometer, gyro and magnetometer at every site.
void add_instruments(XMLElement& root, const XMLElement& body) {
  XMLElement* sensors = root.FirstChildElement("sensor");
  if (!sensors) sensors = root.InsertNewChildElement("sensor");
  for (const XMLElement* site = body.FirstChildElement("site"); site; site = site->NextSiblingElement("site"))
    for (const char* instrument : {"accelerometer", "gyro", "magnetometer"})
      sensors->InsertNewChildElement(instrument)->SetAttribute("site", site->Attribute("name"));
  for (const XMLElement* child = body.FirstChildElement("body"); child; child = child->NextSiblingElement("body"))
    add_instruments(root, *child);
}

double mounting_spread(XMLElement& root) {
  const XMLElement* numeric = root.FirstChildElement("custom")->FirstChildElement("numeric");
  return numeric->DoubleAttribute("data");
}

std::string to_xml(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string with_options(std::string_view mjcf, const MachineOptions& options, Rng rng) {
  tinyxml2::XMLDocument document;
  KINFER_EXPECT(document.Parse(mjcf.data(), mjcf.size()) == tinyxml2::XML_SUCCESS, "{}", document.ErrorStr());
  XMLElement& root = *document.RootElement();
  XMLElement& platform = *root.FirstChildElement("worldbody")->FirstChildElement("body");
  if (options.mounting == Mounting::arbitrary)
    randomise_machine(platform, mounting_spread(root), options, rng.stream(1));
  if (options.slope.rad() != 0.0) tilt_platform(platform, options.slope, rng.stream(2));
  if (options.base != Base::still) prepend_zeros(root, add_base_joints(platform, options.base));
  add_instruments(root, platform);
  return to_xml(document);
}

}  // namespace

std::vector<std::string> machine_names() {
  std::vector<std::string> names{general_excavator};
  for (const MachineFile& file : machine_files()) names.emplace_back(file.name);
  std::ranges::sort(names);
  return names;
}

Result<std::string> machine_mjcf(const std::string& name, const MachineOptions& options, Rng rng) {
  const bool general = name == general_excavator;
  MachineOptions built = options;
  if (general) built.mounting = Mounting::arbitrary;
  for (const MachineFile& file : machine_files())
    if (file.name == (general ? "excavator" : name)) return with_options(file.mjcf, built, rng);
  return error("{}: no such machine; known are {}", name, fmt::join(machine_names(), ", "));
}

}  // namespace kinfer
