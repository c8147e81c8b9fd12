// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "kinfer/base/angle.hpp"
#include "kinfer/io/robot/toml/displacement_field_toml.hpp"
#include "kinfer/io/robot/toml/prediction_toml.hpp"
#include "kinfer/io/robot/toml/robot_toml.hpp"
#include "kinfer/io/text/format_number.hpp"
#include "kinfer/io/text/quoted_text.hpp"

namespace kinfer {
namespace {

const char* convention_of(const Link& link) {
  constexpr const char* names[] = {"dh", "mdh", "urdf"};
  return names[link.index()];
}

std::string list(const Vec3& values, double factor = 1.0) {
  return fmt::format("[{}, {}, {}]", format_number(values[0], factor), format_number(values[1], factor),
                     format_number(values[2], factor));
}

class RobotTomlWriter {
 public:
  RobotTomlWriter(const RobotModel& robot, const StandardDeviations& sd, FileUnits units)
      : robot_(robot),
        chain_(robot.chain),
        sd_(sd),
        in_mm_(units == FileUnits::mm_deg),
        length_(in_mm_ ? 1e-3 : 1.0),
        angle_(in_mm_ ? degree : 1.0) {}

  std::string write() {
    write_header_keys();
    for (std::size_t i = 0; i < chain_.joints.size(); ++i) write_joint(static_cast<int>(i));
    for (const LoopClosure& closure : chain_.closures) write_closure(closure);
    for (const Target& target : chain_.targets) write_fixture("target", target);
    write_fixtures();
    for (const PointMass& mass : chain_.masses)
      add("\n[[mass]]\nlink = {}\ncom = {}\nmass = {}\n", mass.joint + 1, list(mass.com, length_),
          format_number(mass.mass));
    write_tolerances();
    if (robot_.instrument) write_instrument(*robot_.instrument);
    if (!chain_.field.empty()) text_ += format_displacement_field_toml(chain_.field);
    if (robot_.prediction) text_ += format_prediction_toml(*robot_.prediction);
    return std::move(text_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
  }

  void write_header_keys() {
    if (!chain_.name.empty()) add("name = {}\n", quoted_text(chain_.name));
    add("convention = \"{}\"\n", file_convention());
    add("units = {{ length = \"{}\", angle = \"{}\" }}\n", in_mm_ ? "mm" : "m", in_mm_ ? "deg" : "rad");
    write_frame("base", chain_.base);
    write_frame("tool", chain_.tool);
    add("gravity = {}\n", list(chain_.gravity));
    if (!chain_.setup.empty()) add("setup = {}\n", quoted_text(chain_.setup));
    if (chain_.expansion != 0.0) {
      add("expansion = {}\nreference_temperature = {}\n", format_number(chain_.expansion),
          format_number(chain_.reference_temperature));
      if (const double sd = sd_of("expansion"); !std::isnan(sd)) add("expansion_sd = {}\n", format_number(sd));
    }
    if (chain_.tip >= 0) add("tip = {}\n", quoted_text(name_of(chain_.tip)));
    for_each_fixture_list(chain_.fixtures, [&]<class T>(const auto& row, const std::vector<T>& list) {
      if constexpr (std::is_same_v<T, Vec3>) write_points(row.kind, list);
    });
  }

  /// Points without a name, in one array: "anchors" of the kind "anchor".
  void write_points(std::string_view kind, const std::vector<Vec3>& points) {
    std::string values, deviations;
    bool any = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const char* comma = i == 0 ? "" : ", ";
      const std::string sd = sd_list(fmt::format("{}{}_", kind, i + 1).c_str(), "", "", length_);
      any |= !sd.empty();
      values += comma + list(points[i], length_);
      deviations += comma + (sd.empty() ? "[nan, nan, nan]" : sd);
    }
    if (!points.empty()) add("{}s = [{}]\n", kind, values);
    if (any) add("{}s_sd = [{}]\n", kind, deviations);
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

  /// "[0.1, nan, 0.2]": nan where that number has no standard deviation; empty where none has.
  std::string sd_list(const char* prefix, const char* rotation, const std::string& suffix, double factor) const {
    Vec3 values;
    for (int i = 0; i < 3; ++i) values[i] = sd_of(fmt::format("{}{}{}{}", prefix, rotation, "xyz"[i], suffix));
    return values.array().isNaN().all() ? "" : list(values, factor);
  }

  /// A target or socket, with its standard deviation.
  void write_fixture(std::string_view kind, const Target& point) {
    add("\n[[{}]]\nname = {}\nxyz = {}\n", kind, quoted_text(point.name), list(point.xyz, length_));
    const std::string sd = sd_list(fmt::format("{}_{}_", kind, point.name).c_str(), "", "", length_);
    if (!sd.empty()) add("xyz_sd = {}\n", sd);
  }

  void write_fixture(std::string_view kind, const Plane& plane) {
    add("\n[[{}]]\nname = {}\nnormal = {}\noffset = {}\n", kind, quoted_text(plane.name), list(plane.normal()),
        format_number(plane.offset, length_));
  }

  void write_fixture(std::string_view kind, const NamedFrame& fixture) {
    add("\n[[{}]]\nname = {}\n", kind, quoted_text(fixture.name));
    const Frame& frame = fixture.frame;
    add("xyz = {}\nrpy = {}\n", list(frame.xyz, length_), list(to_rpy(frame.pose().rotation), angle_));
    const std::string prefix = fmt::format("{}_{}_", kind, fixture.name);
    const std::string xyz = sd_list(prefix.c_str(), "", "", length_),
                      rotation = sd_list(prefix.c_str(), "r", "", angle_);
    if (!xyz.empty()) add("xyz_sd = {}\n", xyz);
    if (!rotation.empty()) add("turn_sd = {}\n", rotation);
  }

  void write_fixtures() {
    const Fixtures& fixtures = chain_.fixtures;
    for_each_fixture_list(fixtures, [&]<class T>(const auto& row, const std::vector<T>& list) {
      if constexpr (!std::is_same_v<T, Vec3>)
        for (const T& fixture : list) write_fixture(row.kind, fixture);
    });
    for (const SocketDistance& known : fixtures.socket_distances)
      add("\n[[socket_distance]]\nfrom = {}\nto = {}\ndistance = {}\nsigma = {}\n",
          quoted_text(fixtures.sockets[known.a].name), quoted_text(fixtures.sockets[known.b].name),
          format_number(known.distance, length_), format_number(known.sd, length_));
    for (const RobotMounting& mounting : chain_.mountings) {
      add("\n[[mounting]]\nname = {}\n", quoted_text(mounting.name));
      if (mounting.tip >= 0) add("tip = {}\n", quoted_text(name_of(mounting.tip)));
      if (mounting.base) write_frame("base", *mounting.base, "@" + mounting.name);
      write_frame("tool", mounting.tool, "@" + mounting.name);
    }
  }

  void write_frame(const char* name, const Frame& frame, const std::string& of = "") {
    add("{} = {{ xyz = {}, rpy = {} }}\n", name, list(frame.xyz, length_), list(to_rpy(frame.pose().rotation), angle_));
    const std::string prefix = fmt::format("{}_", name);
    const std::string xyz = sd_list(prefix.c_str(), "", of, length_),
                      rotation = sd_list(prefix.c_str(), "r", of, angle_);
    if (xyz.empty() && rotation.empty()) return;
    add("{}_sd = {{ {}{}{}{}{} }}\n", name, xyz.empty() ? "" : "xyz = ", xyz,
        xyz.empty() || rotation.empty() ? "" : ", ", rotation.empty() ? "" : "turn = ", rotation);
  }

  void write_number(const char* key, int joint, double value, double factor) {
    add("{} = {}\n", key, format_number(value, factor));
    const double sd = sd_of(fmt::format("{}{}", key, joint + 1));
    if (!std::isnan(sd)) add("{}_sd = {}\n", key, format_number(sd, factor));
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
    const std::string xyz = sd_list("", "", number, length_), rotation = sd_list("", "r", number, angle_);
    if (!xyz.empty()) add("xyz_sd = {}\n", xyz);
    if (!rotation.empty()) add("turn_sd = {}\n", rotation);
  }

  void write_joint(int index) {
    const Joint& joint = chain_.joints[index];
    add("\n[[joint]]\nname = {}\ntype = \"{}\"\n", quoted_text(name_of(index)), traits(joint.type).name);
    if (joint.parent != index - 1)
      add("parent = {}\n", quoted_text(joint.parent < 0 ? base_parent_name() : name_of(joint.parent)));
    if (convention_of(joint.link) != std::string(file_convention()))
      add("convention = \"{}\"\n", convention_of(joint.link));
    std::visit([&](const auto& link) { write_link(index, link); }, joint.link);
    if (has_position(joint.type)) write_motion(index, joint);
  }

  void write_closure(const LoopClosure& closure) {
    const auto frame = [&](int joint) { return joint < 0 ? base_parent_name() : name_of(joint); };
    add("\n[[closure]]\nname = {}\nfirst = {}\nsecond = {}\n", quoted_text(closure.name),
        quoted_text(frame(closure.first)), quoted_text(frame(closure.second)));
    add("point_in_first = {}\naxis_in_first = {}\n", list(closure.point_in_first, length_),
        list(closure.axis_in_first));
    add("point_in_second = {}\naxis_in_second = {}\n", list(closure.point_in_second, length_),
        list(closure.axis_in_second));
  }

  void write_motion(int index, const Joint& joint) {
    if (!joint.is_active) add("reading = false\n");
    if (joint.gain != 1.0 || sd_.count(fmt::format("gain{}", index + 1))) write_number("gain", index, joint.gain, 1.0);
    if (joint.compliance != 0.0 || sd_.count(fmt::format("compliance{}", index + 1)))
      write_number("compliance", index, joint.compliance, 1.0);
    const double unit = translates(joint.type) ? length_ : angle_;
    if (joint.torque_compliance != 0.0) write_number("torque_compliance", index, joint.torque_compliance, 1.0);
    if (joint.backlash != 0.0) write_number("backlash", index, joint.backlash, unit);
    write_harmonics(index, joint);
    if (std::isfinite(joint.lower) || std::isfinite(joint.upper))
      add("limits = [{}, {}]\n", format_number(joint.lower, unit), format_number(joint.upper, unit));
    for (std::size_t i = 0; i < joint.couplings.size(); ++i)
      add("{}{} = {}{}", i == 0 ? "coupling = { " : ", ", quoted_text(name_of(joint.couplings[i].joint)),
          format_number(joint.couplings[i].factor), i + 1 == joint.couplings.size() ? " }\n" : "");
  }

  /// Order, sine and cosine of each, and the standard deviations of the last two.
  void write_harmonics(int index, const Joint& joint) {
    if (joint.harmonics.empty()) return;
    std::string values, deviations;
    bool any = false;
    for (const Harmonic& h : joint.harmonics) {
      const char* comma = values.empty() ? "" : ", ";
      const std::string line = fmt::format("{:g}q{}", h.order, index + 1);
      const double sine = sd_of("sin" + line), cosine = sd_of("cos" + line);
      any |= !std::isnan(sine);
      values += fmt::format("{}[{}, {}, {}]", comma, format_number(h.order), format_number(h.sine, angle_),
                            format_number(h.cosine, angle_));
      deviations += fmt::format("{}[{}, {}, {}]", comma, format_number(h.order), format_number(sine, angle_),
                                format_number(cosine, angle_));
    }
    add("harmonics = [{}]\n", values);
    if (any) add("harmonics_sd = [{}]\n", deviations);
  }

  /// The parent name that means the base: "base", or "" where a joint has that name.
  std::string base_parent_name() const {
    for (const Joint& joint : chain_.joints)
      if (joint.name == "base") return "";
    return "base";
  }

  void write_tolerances() {
    const Tolerances& t = robot_.tolerances;
    add("\n[tolerance]\nlength = {}\nangle = {}\n", format_number(t.length, length_), format_number(t.angle, angle_));
    add("base_length = {}\nbase_angle = {}\n", format_number(t.base_length, length_),
        format_number(t.base_angle, angle_));
    add("tool_length = {}\ntool_angle = {}\n", format_number(t.tool_length, length_),
        format_number(t.tool_angle, angle_));
    add("gain = {}\ncompliance = {}\nanchor = {}\n", format_number(t.gain), format_number(t.compliance),
        format_number(t.anchor, length_));
  }

  double unit_of(ResidualUnit unit) const {
    return unit == ResidualUnit::length ? length_ : unit == ResidualUnit::angle ? angle_ : 1.0;
  }

  void write_instrument(const Instrument& instrument) {
    const bool has_angle = instrument.sigma_angle > 0.0;
    add("\n[instrument]\nkind = \"{}\"\n", has_angle ? "pose" : "position");
    if (instrument.states_lengths()) add("sigma = {}\n", format_number(instrument.sigma, length_));
    if (has_angle) add("sigma_angle = {}\n", format_number(instrument.sigma_angle, angle_));
    add("ppm = {}\n", format_number(instrument.ppm));
    for (const InstrumentSigma& sigma : instrument_sigmas)
      if (const auto& value = instrument.*sigma.value)
        add("{} = {}\n", sigma.key, format_number(*value, unit_of(sigma.unit)));
    if (robot_.instrument_position) add("at = {}\n", list(*robot_.instrument_position, length_));
  }

  const RobotModel& robot_;
  const Chain& chain_;
  const StandardDeviations& sd_;
  bool in_mm_;
  double length_, angle_;  ///< of the file's units, in SI
  std::string text_;
};

}  // namespace

std::string format_robot_toml(const RobotModel& robot, const StandardDeviations& sd, FileUnits units) {
  return RobotTomlWriter(robot, sd, units).write();
}

}  // namespace kinfer
