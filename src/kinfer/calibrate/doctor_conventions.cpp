#include "kinfer/calibrate/doctor_conventions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

enum class Remedy { apply, tell_only };

struct Hypothesis {
  std::string kind, sentence, suggestion;
  Remedy remedy = Remedy::apply;
  std::function<void(Chain&, PoseSet&)> apply;
};

bool turns(const Chain& chain, int joint) {
  return chain.joints[joint].type == JointType::revolute;
}

/// Multiplies the readings, read back and commanded, of reading k.
void scale_reading(PoseSet& data, Eigen::Index k, double factor) {
  data.joints.row(k) *= factor;
  if (data.commanded.size() > 0) data.commanded.row(k) *= factor;
}

void scale_points(PoseSet& data, double factor) {
  for (PointMeasurement& point : data.points) {
    point.position *= factor;
    if (point.sd) *point.sd *= factor;
  }
  for (OrientationMeasurement& measured : data.orientations)
    if (measured.with_point) *measured.with_point *= factor;
}

void add_offset(Joint& joint, double angle) {
  if (auto* dh = std::get_if<DhLink>(&joint.link)) dh->theta += angle;
  if (auto* mdh = std::get_if<MdhLink>(&joint.link)) mdh->theta += angle;
  if (auto* urdf = std::get_if<UrdfLink>(&joint.link))
    urdf->origin = Frame::from_pose({urdf->origin.pose().rotation * exp_so3(angle * urdf->axis), urdf->origin.xyz});
}

void add_unit_hypotheses(const Chain& chain, std::vector<Hypothesis>& list) {
  const std::vector<int> moving = joints_with_reading(chain);
  const auto all = [&](JointType type, double factor) {
    return [&chain, moving, type, factor](Chain&, PoseSet& data) {
      for (std::size_t k = 0; k < moving.size(); ++k)
        if (chain.joints[moving[k]].type == type) scale_reading(data, static_cast<Eigen::Index>(k), factor);
    };
  };
  list.push_back({"degrees_for_radians", "the joint readings are degrees, but were read as radians",
                  "write the unit into the header: q1[deg], q2[deg], ...", Remedy::apply,
                  all(JointType::revolute, degree)});
  list.push_back({"radians_for_degrees", "the joint readings are radians, but were read as degrees",
                  "write the unit into the header: q1[rad], q2[rad], ...", Remedy::apply,
                  all(JointType::revolute, 1.0 / degree)});
  list.push_back({"length_unit", "the measured positions are millimetres, but were read as metres",
                  "write the unit into the header: x[mm], y[mm], z[mm]", Remedy::apply,
                  [](Chain&, PoseSet& data) { scale_points(data, 1e-3); }});
  list.push_back({"length_unit", "the measured positions are metres, but were read as millimetres",
                  "write the unit into the header: x[m], y[m], z[m]", Remedy::apply,
                  [](Chain&, PoseSet& data) { scale_points(data, 1e3); }});
  list.push_back({"length_unit", "the measured positions are inches, but were read as millimetres",
                  "convert them: kinfer knows m, mm and um", Remedy::apply,
                  [](Chain&, PoseSet& data) { scale_points(data, 25.4); }});
  for (std::size_t k = 0; k < moving.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const std::string& name = chain.joints[moving[k]].name;
    const auto add = [&](const char* kind, const char* is, const char* read_as, const char* unit, double factor) {
      list.push_back({kind, fmt::format("{} is in {}, but was read as {}", name, is, read_as),
                      fmt::format("write its unit into the header: q{}[{}]", k + 1, unit), Remedy::apply,
                      [row, factor](Chain&, PoseSet& data) { scale_reading(data, row, factor); }});
    };
    if (turns(chain, moving[k])) {
      add("degrees_for_radians", "degrees", "radians", "deg", degree);
      add("radians_for_degrees", "radians", "degrees", "rad", 1.0 / degree);
    } else {
      add("length_unit", "millimetres", "metres", "mm", 1e-3);
      add("length_unit", "metres", "millimetres", "m", 1e3);
    }
  }
}

void add_joint_hypotheses(const Chain& chain, std::vector<Hypothesis>& list) {
  const std::vector<int> moving = joints_with_reading(chain);
  for (const int j : moving) {
    const std::string& name = chain.joints[j].name;
    list.push_back({"wrong_sign", fmt::format("{} counts in the other sense than the robot file says", name),
                    fmt::format("give {} gain = {:g} in the robot file", name, -chain.joints[j].gain), Remedy::apply,
                    [j](Chain& c, PoseSet&) { c.joints[j].gain = -c.joints[j].gain; }});
  }
  for (const int j : moving) {
    const std::string& name = chain.joints[j].name;
    if (!turns(chain, j)) continue;
    for (const int offset : {90, -90, 180})
      list.push_back({"joint_offset", fmt::format("{} is {} deg off its zero in the robot file", name, offset),
                      fmt::format("add {} deg to the zero position (theta) of {} in the robot file", offset, name),
                      Remedy::apply, [j, offset](Chain& c, PoseSet&) { add_offset(c.joints[j], offset * degree); }});
  }
}

/// Columns in another order, and joints that count from the ground instead of from the link before.
void add_relation_hypotheses(const Chain& chain, std::vector<Hypothesis>& list) {
  const std::vector<int> moving = joints_with_reading(chain);
  for (std::size_t k = 0; k < moving.size(); ++k)
    for (std::size_t m = 0; m < k; ++m) {
      const int j = moving[k], i = moving[m];
      if (chain.joints[i].type != chain.joints[j].type) continue;
      const auto a = static_cast<Eigen::Index>(m), b = static_cast<Eigen::Index>(k);
      list.push_back(
          {"columns_swapped",
           fmt::format("the readings of {} and {} are exchanged", chain.joints[i].name, chain.joints[j].name),
           fmt::format("exchange the headers of q{} and q{}", m + 1, k + 1), Remedy::apply,
           [a, b](Chain&, PoseSet& data) {
             data.joints.row(a).swap(data.joints.row(b));
             if (data.commanded.size() > 0) data.commanded.row(a).swap(data.commanded.row(b));
           }});
      if (m + 1 != k || !turns(chain, j)) continue;
      for (const int factor : {1, -1})
        list.push_back({"joint_coupled",
                        fmt::format("{} moves {} {}: a belt or a parallel linkage couples them", chain.joints[j].name,
                                    factor > 0 ? "with" : "against", chain.joints[i].name),
                        fmt::format("give {} coupling = {{ {} = {} }} in the robot file", chain.joints[j].name,
                                    chain.joints[i].name, factor),
                        Remedy::apply, [j, i, factor](Chain& c, PoseSet&) {
                          c.joints[j].couplings.push_back({i, static_cast<double>(factor)});
                        }});
    }
}

std::vector<Hypothesis> hypotheses(const Chain& chain) {
  std::vector<Hypothesis> list;
  add_unit_hypotheses(chain, list);
  add_joint_hypotheses(chain, list);
  add_relation_hypotheses(chain, list);
  list.push_back({"mirrored", "the measured positions are a mirror image: their axes are not right-handed",
                  "turn the sign of one of x, y, z, or exchange two of them", Remedy::tell_only,
                  [](Chain&, PoseSet& data) {
                    for (PointMeasurement& point : data.points) point.position.x() *= -1.0;
                  }});
  return list;
}

/// A set of hypotheses taken together, and what is left of the error then.
struct Explanation {
  std::vector<std::size_t> taken;  // ascending, into the list of hypotheses
  Chain chain;
  PoseSet data;
  double typical = 0.0;
  std::vector<std::vector<std::size_t>> others{};  // that explain the points as well
};

class HypothesisSearch {
 public:
  explicit HypothesisSearch(const CalibrateTask& task)
      : list_(hypotheses(task.nominal)),
        believable_(believable_error(task)),
        plain_{{}, task.nominal, thinned_points(task.data, rows), 0.0} {}

  /// The explanation with the fewest hypotheses that leaves a believable error; none where none is needed or found.
  std::optional<Explanation> run() {
    if (plain_.data.rows() < fewest_rows || !judge(plain_) || plain_.typical <= believable_) return std::nullopt;
    std::vector<Explanation> beam{plain_};
    for (int depth = 0; depth < deepest; ++depth) {
      std::vector<Explanation> next;
      for (const Explanation& base : beam) expand(base, next);
      std::stable_sort(next.begin(), next.end(),
                       [](const Explanation& a, const Explanation& b) { return a.typical < b.typical; });
      if (next.empty()) return std::nullopt;
      if (explains(next.front())) return first_as_good(next);
      if (next.size() > width) next.erase(next.begin() + width, next.end());
      beam = std::move(next);
    }
    return std::nullopt;
  }

  const Hypothesis& operator[](std::size_t i) const { return list_[i]; }

 private:
  static constexpr std::size_t rows = 40, width = 4;
  static constexpr int fewest_rows = 8;  // base and tool are nine unknowns; the rest must speak
  static constexpr int deepest = 3;      // faults at once

  static bool judge(Explanation& e) {
    const auto fit = quick_fit(e.chain, e.data);
    if (!fit) return false;
    e.typical = fit->typical;
    return std::isfinite(e.typical);
  }

  /// Some faults are the same to base and tool, a wrist's half turn and the sign of the joint after it: of those that
  /// explain the points equally well, the one first in the list; it names the others.
  static Explanation first_as_good(const std::vector<Explanation>& sorted) {
    constexpr double as_good = 1.5;
    std::vector<const Explanation*> equal;
    for (const Explanation& e : sorted)
      if (e.typical <= as_good * sorted.front().typical) equal.push_back(&e);
    std::sort(equal.begin(), equal.end(), [](const auto* a, const auto* b) { return a->taken < b->taken; });
    Explanation first = *equal.front();
    for (std::size_t i = 1; i < equal.size(); ++i) first.others.push_back(equal[i]->taken);
    return first;
  }

  void expand(const Explanation& base, std::vector<Explanation>& next) const {
    const std::size_t first = base.taken.empty() ? 0 : base.taken.back() + 1;
    for (std::size_t i = first; i < list_.size(); ++i) {
      Explanation e = base;
      e.taken.push_back(i);
      list_[i].apply(e.chain, e.data);
      if (judge(e)) next.push_back(std::move(e));
    }
  }

  /// Believable by the tolerances, or so much better than without that a poor nominal model must be the rest.
  bool explains(const Explanation& e) const {
    constexpr double far_better = 0.05;
    return e.typical <= believable_ ? e.typical < 0.2 * plain_.typical : e.typical < far_better * plain_.typical;
  }

  std::vector<Hypothesis> list_;
  double believable_;
  Explanation plain_;
};

/// A robot of a few millimetres or of a hundred metres: its file, not the measurement, has the wrong unit.
void check_size_of_robot(DoctorCase& patient) {
  const Chain& chain = patient.task.nominal;
  double reach = chain.tool.xyz.norm();
  for (const PlacedJoint& joint : placed_joints(chain, VectorXd::Zero(dof(chain))))
    reach = std::max(reach, (joint.frame.position - chain.base.xyz).norm());
  constexpr double smallest = 0.01, largest = 100.0;  // [m]
  if (reach > smallest && reach < largest) return;
  add_finding(patient, {.kind = "robot_length_unit",
                        .severity = Severity::fault,
                        .sentence = fmt::format("the robot reaches {:g} m by its file", reach),
                        .suggestion = "check units = { length = ... } in the robot file"});
}

}  // namespace

void check_conventions(DoctorCase& patient) {
  check_size_of_robot(patient);
  if (patient.task.data.points.empty()) return;
  HypothesisSearch search(patient.task);
  const auto found = search.run();
  if (!found) return;
  for (const std::size_t i : found->taken) {
    const Hypothesis& h = search[i];
    const bool apply = h.remedy == Remedy::apply;
    if (apply) h.apply(patient.task.nominal, patient.task.data);
    std::string sentence = h.sentence;
    for (const auto& other : found->others)
      if (found->taken.size() == 1) sentence += "; or, which comes to the same, " + search[other.front()].sentence;
    add_finding(patient, {.kind = h.kind,
                          .severity = Severity::fault,
                          .sentence = sentence,
                          .suggestion = h.suggestion,
                          .applied = apply});
  }
}

}  // namespace kinfer
