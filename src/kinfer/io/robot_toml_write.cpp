#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/digits.hpp"
#include "kinfer/io/robot_toml.hpp"

namespace kinfer {
namespace {

const char* convention_of(const Link& link) {
  constexpr const char* names[] = {"dh", "mdh", "urdf"};
  return names[link.index()];
}

const char* type_name(JointType type) {
  switch (type) {
    case JointType::revolute:
      return "revolute";
    case JointType::prismatic:
      return "prismatic";
    case JointType::fixed:
      return "fixed";
  }
  return "fixed";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      result += c;
  }
  return result + '"';
}

std::string list(const Vec3& values, double factor = 1.0) {
  return fmt::format("[{}, {}, {}]", digits(values[0], factor), digits(values[1], factor), digits(values[2], factor));
}

class Writer {
 public:
  Writer(const RobotModel& robot, const StandardDeviations& sd, FileUnits units)
      : robot_(robot),
        chain_(robot.chain),
        sd_(sd),
        in_mm_(units == FileUnits::mm_deg),
        length_(in_mm_ ? 1e-3 : 1.0),
        angle_(in_mm_ ? degree : 1.0) {}

  std::string write() {
    write_head();
    for (std::size_t i = 0; i < chain_.joints.size(); ++i) write_joint(static_cast<int>(i));
    for (const Target& target : chain_.targets)
      add("\n[[target]]\nname = {}\nxyz = {}\n", quoted(target.name), list(target.xyz, length_));
    for (const PointMass& mass : chain_.masses)
      add("\n[[mass]]\nlink = {}\ncom = {}\nmass = {}\n", mass.joint + 1, list(mass.com, length_), digits(mass.mass));
    write_tolerances();
    if (robot_.instrument) write_instrument(*robot_.instrument);
    return std::move(text_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }

  void write_head() {
    if (!chain_.name.empty()) add("name = {}\n", quoted(chain_.name));
    add("convention = \"{}\"\n", file_convention());
    add("units = {{ length = \"{}\", angle = \"{}\" }}\n", in_mm_ ? "mm" : "m", in_mm_ ? "deg" : "rad");
    write_frame("base", chain_.base);
    write_frame("tool", chain_.tool);
    add("gravity = {}\n", list(chain_.gravity));
    if (chain_.tip >= 0) add("tip = {}\n", quoted(name_of(chain_.tip)));
    for (std::size_t i = 0; i < robot_.anchors.size(); ++i)
      add("{}{}{}", i == 0 ? "anchors = [" : ", ", list(robot_.anchors[i], length_),
          i + 1 == robot_.anchors.size() ? "]\n" : "");
  }

  const char* file_convention() const { return chain_.joints.empty() ? "mdh" : convention_of(chain_.joints[0].link); }

  std::string name_of(int joint) const {
    const std::string& name = chain_.joints[joint].name;
    return name.empty() ? fmt::format("J{}", joint + 1) : name;
  }

  double sd_of(const std::string& parameter) const {
    const auto found = sd_.find(parameter);
    return found == sd_.end() ? std::nan("") : found->second;
  }

  /// "[0.1, nan, 0.2]": nan where that number has no standard deviation; nothing where none has.
  std::string sd_list(const char* prefix, const char* turn, const std::string& suffix, double factor) const {
    Vec3 values;
    for (int i = 0; i < 3; ++i) values[i] = sd_of(fmt::format("{}{}{}{}", prefix, turn, "xyz"[i], suffix));
    return values.array().isNaN().all() ? "" : list(values, factor);
  }

  void write_frame(const char* name, const Frame& frame) {
    add("{} = {{ xyz = {}, rpy = {} }}\n", name, list(frame.xyz, length_), list(to_rpy(frame.pose().rotation), angle_));
    const std::string prefix = fmt::format("{}_", name);
    const std::string xyz = sd_list(prefix.c_str(), "", "", length_), turn = sd_list(prefix.c_str(), "r", "", angle_);
    if (xyz.empty() && turn.empty()) return;
    add("{}_sd = {{ {}{}{}{}{} }}\n", name, xyz.empty() ? "" : "xyz = ", xyz, xyz.empty() || turn.empty() ? "" : ", ",
        turn.empty() ? "" : "turn = ", turn);
  }

  void write_number(const char* key, int joint, double value, double factor) {
    add("{} = {}\n", key, digits(value, factor));
    const double sd = sd_of(fmt::format("{}{}", key, joint + 1));
    if (!std::isnan(sd)) add("{}_sd = {}\n", key, digits(sd, factor));
  }

  void write_link(int index, const DhNumbers& link) {
    write_number("a", index, link.a, length_);
    write_number("alpha", index, link.alpha, angle_);
    write_number("d", index, link.d, length_);
    write_number("theta", index, link.theta, angle_);
    if (link.beta != 0.0 || sd_.count(fmt::format("beta{}", index + 1))) write_number("beta", index, link.beta, angle_);
  }

  void write_link(int index, const UrdfLink& link) {
    add("xyz = {}\nrpy = {}\n", list(link.origin.xyz, length_), list(to_rpy(link.origin.pose().rotation), angle_));
    add("axis = {}\n", list(link.axis));
    const std::string number = fmt::format("{}", index + 1);
    const std::string xyz = sd_list("", "", number, length_), turn = sd_list("", "r", number, angle_);
    if (!xyz.empty()) add("xyz_sd = {}\n", xyz);
    if (!turn.empty()) add("turn_sd = {}\n", turn);
  }

  void write_joint(int index) {
    const Joint& joint = chain_.joints[index];
    add("\n[[joint]]\nname = {}\ntype = \"{}\"\n", quoted(name_of(index)), type_name(joint.type));
    if (joint.parent != index - 1) add("parent = {}\n", quoted(joint.parent < 0 ? base_word() : name_of(joint.parent)));
    if (convention_of(joint.link) != std::string(file_convention()))
      add("convention = \"{}\"\n", convention_of(joint.link));
    std::visit([&](const auto& link) { write_link(index, link); }, joint.link);
    if (joint.type != JointType::fixed) write_motion(index, joint);
  }

  void write_motion(int index, const Joint& joint) {
    if (!joint.has_reading) add("reading = false\n");
    if (joint.gain != 1.0 || sd_.count(fmt::format("gain{}", index + 1))) write_number("gain", index, joint.gain, 1.0);
    if (joint.compliance != 0.0 || sd_.count(fmt::format("compliance{}", index + 1)))
      write_number("compliance", index, joint.compliance, 1.0);
    const double unit = joint.type == JointType::prismatic ? length_ : angle_;
    if (std::isfinite(joint.lower) || std::isfinite(joint.upper))
      add("limits = [{}, {}]\n", digits(joint.lower, unit), digits(joint.upper, unit));
    for (std::size_t i = 0; i < joint.couplings.size(); ++i)
      add("{}{} = {}{}", i == 0 ? "coupling = { " : ", ", quoted(name_of(joint.couplings[i].joint)),
          digits(joint.couplings[i].factor), i + 1 == joint.couplings.size() ? " }\n" : "");
  }

  /// How a joint says that it starts at the base, where another joint has taken the word.
  std::string base_word() const {
    for (const Joint& joint : chain_.joints)
      if (joint.name == "base") return "";
    return "base";
  }

  void write_tolerances() {
    const Tolerances& t = robot_.tolerances;
    add("\n[tolerance]\nlength = {}\nangle = {}\n", digits(t.length, length_), digits(t.angle, angle_));
    add("base_length = {}\nbase_angle = {}\n", digits(t.base_length, length_), digits(t.base_angle, angle_));
    add("tool_length = {}\ntool_angle = {}\n", digits(t.tool_length, length_), digits(t.tool_angle, angle_));
    add("gain = {}\ncompliance = {}\nanchor = {}\n", digits(t.gain), digits(t.compliance), digits(t.anchor, length_));
  }

  void write_instrument(const Instrument& instrument) {
    const bool has_angle = instrument.sigma_angle > 0.0;
    add("\n[instrument]\nkind = \"{}\"\nsigma = {}\n", has_angle ? "pose" : "position",
        digits(instrument.sigma, length_));
    if (has_angle) add("sigma_angle = {}\n", digits(instrument.sigma_angle, angle_));
    add("ppm = {}\n", digits(instrument.ppm));
  }

  const RobotModel& robot_;
  const Chain& chain_;
  const StandardDeviations& sd_;
  bool in_mm_;
  double length_, angle_;  ///< of the file's units, in SI
  std::string text_;
};

}  // namespace

std::string robot_toml(const RobotModel& robot, const StandardDeviations& sd, FileUnits units) {
  return Writer(robot, sd, units).write();
}

}  // namespace kinfer
