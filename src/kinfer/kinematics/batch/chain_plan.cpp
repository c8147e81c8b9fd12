// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/chain_plan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/elementary_motions.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

/// 0: the base, 1: the tool, 2 and more: the joints. None: not a number of the chain itself.
std::optional<int> place_in_chain(const ParameterAddress& at) {
  if (const JointNumber* number = joint_number(at)) return 2 + number->joint;
  if (is_own_frame_parameter(at, SetupFrame::base)) return 0;
  return is_own_frame_parameter(at, SetupFrame::tool) ? std::optional(1) : std::nullopt;
}

bool is_geometry_or_gain(const ParameterAddress& at) {
  return place_in_chain(at) && field_of(at) <= Field::gain;
}

}  // namespace

bool has_batch_form(const Chain& chain, const ParameterSet& set) {
  const auto free = set.free();
  return !has_non_geometric_terms(chain) && chain.mountings.empty() &&
         std::all_of(free.begin(), free.end(), [](const Parameter* p) { return is_geometry_or_gain(p->at); });
}

namespace batch {
namespace {

using elementary::Motion;

bool is_angle(Field field) {
  constexpr std::array angles{Field::rx, Field::ry, Field::rz, Field::alpha, Field::theta, Field::beta};
  return std::find(angles.begin(), angles.end(), field) != angles.end();
}

/// Finds the parameter, if any, that sets a number of the chain.
class Lookup {
 public:
  explicit Lookup(const ParameterSet& set) {
    for (const Parameter* p : set.free()) {
      const Field field = field_of(p->at).value_or(Field::coupling);
      const int place = place_in_chain(p->at).value_or(-1);
      angle_.push_back(is_angle(field) ? static_cast<int>(angles_.size()) : -1);
      if (is_angle(field)) angles_.push_back(static_cast<int>(keys_.size()));
      keys_.push_back({place, field});
      frees_base_ |= place == 0, fields_ |= bit(field);
    }
  }

  /// Of a field of the base, the tool or a joint (place_in_chain).
  Value value(int place, Field field, double constant, Motion motion) const {
    Value value{.constant = constant};
    if (motion == Motion::rotation && constant != 0.0) value.cos = std::cos(constant), value.sin = std::sin(constant);
    value.parameter = index_of({place, field});
    if (value.parameter >= 0) value.angle = angle_[value.parameter];
    return value;
  }
  bool frees_base() const { return frees_base_; }
  const std::vector<int>& angles() const { return angles_; }

 private:
  struct Key {
    int place;
    Field field;
    bool operator==(const Key&) const = default;
  };
  static std::uint32_t bit(Field field) { return std::uint32_t{1} << static_cast<int>(field); }

  /// Callers walk along the chain, and most sets are in that order: the search starts after the last match.
  int index_of(const Key& key) const {
    if (!(fields_ & bit(key.field))) return -1;
    const auto next = keys_.begin() + next_;
    auto found = std::find(next, keys_.end(), key);
    if (found == keys_.end()) found = std::find(keys_.begin(), next, key);
    if (found == next && (next == keys_.end() || !(*next == key))) return -1;
    next_ = found - keys_.begin() + 1;
    return static_cast<int>(next_ - 1);
  }

  std::vector<Key> keys_;
  std::vector<int> angles_, angle_;  // of a parameter: its index among the angles
  std::uint32_t fields_ = 0;         // one bit each
  bool frees_base_ = false;
  mutable std::ptrdiff_t next_ = 0;
};

/// Calls visit.move for each elementary motion and visit.rotate for each constant rotation.
template <class Visitor>
struct Walker {
  const Lookup& lookup;
  Visitor& visit;
  int place = 0;  // place_in_chain
  int joint = -1;

  void operator()(const Mat3& rotation) {
    if (rotation != Mat3::Identity()) visit.rotate(rotation);
  }
  void operator()(const elementary::Factor& factor) {
    visit.move(factor,
               factor.field ? lookup.value(place, *factor.field, factor.value, factor.motion)
                            : Value{.constant = factor.value},
               joint);
  }
};

template <class Visitor>
void walk(const Frame& frame, SetupFrame which, const Lookup& lookup, Visitor& visit) {
  elementary::for_each_factor(frame, Walker<Visitor>{lookup, visit, which == SetupFrame::base ? 0 : 1, -1});
}
template <class Visitor>
void walk(const Joint& joint, int index, const Lookup& lookup, Visitor& visit) {
  elementary::for_each_factor(joint, Walker<Visitor>{lookup, visit, 2 + index, index});
}

Factor rotation_factor(const Mat3& rotation) {
  Factor factor{.kind = Factor::Kind::constant_rotation, .axis = 0, .value = {}, .rotation = {}};
  for (int i = 0; i < 9; ++i) factor.rotation[i] = rotation(i / 3, i % 3);
  return factor;
}

/// Collects the factors between consecutive joint motions.
struct FactorCollector {
  std::vector<std::vector<Factor>> lists{{}};

  FactorCollector() { lists.back().reserve(usual); }

  void rotate(const Mat3& rotation) { lists.back().push_back(rotation_factor(rotation)); }
  void move(const elementary::Factor& factor, const Value& value, int) {
    const auto kind = factor.motion == Motion::rotation ? Factor::Kind::axis_rotation : Factor::Kind::axis_translation;
    if (value.parameter >= 0 || value.constant != 0.0)
      lists.back().push_back({.kind = kind, .axis = factor.axis, .value = value, .rotation = {}});
    if (!factor.moves) return;
    KINFER_EXPECT(factor.axis == 2, "every convention moves about or along z");
    lists.emplace_back().reserve(usual);
  }

 private:
  static constexpr std::size_t usual = 6;  // factors between two joints
};

Pose product(const std::vector<Factor>& factors) {
  Pose pose;
  for (const Factor& f : factors) {
    if (f.kind == Factor::Kind::constant_rotation) {
      pose.rotation *= Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(f.rotation);
    } else {
      elementary::apply(pose, f.kind == Factor::Kind::axis_rotation ? Motion::rotation : Motion::translation, f.axis,
                        f.value.constant);
    }
  }
  return pose;
}

/// TransZ(d) TransX(a) RotX(alpha) RotZ(theta), each at most once; what commutes may come in any order.
bool parse_link(const std::vector<Factor>& factors, Segment& segment) {
  using enum Factor::Kind;
  int stage = 0;  // 0: before alpha, 1: after alpha, 2: after theta
  bool has_a = false, has_d = false;
  for (const Factor& f : factors) {
    if (f.kind == axis_translation && f.axis == 2 && stage == 0 && !has_d) {
      segment.d = f.value, has_d = true;
    } else if (f.kind == axis_translation && f.axis == 0 && stage <= 1 && !has_a) {
      segment.a = f.value, has_a = true;
    } else if (f.kind == axis_rotation && f.axis == 0 && stage == 0) {
      segment.alpha = f.value, stage = 1;
    } else if (f.kind == axis_rotation && f.axis == 2 && stage <= 1) {
      segment.theta = f.value, stage = 2;
    } else {
      return false;
    }
  }
  return true;
}

Segment segment_of(const std::vector<Factor>& factors) {
  Segment segment;
  segment.varies = std::any_of(factors.begin(), factors.end(), [](const Factor& f) { return f.value.parameter >= 0; });
  if (factors.empty()) return segment;
  segment.shape = Shape::general;
  segment.factors = factors.data(), segment.factor_count = static_cast<int>(factors.size());
  if (segment.varies) {
    if (parse_link(factors, segment)) segment.shape = Shape::link;
    return segment;
  }
  const Pose pose = product(factors);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) segment.numbers[4 * row + col] = pose.rotation(row, col);
    segment.numbers[4 * row + 3] = pose.position[row];
  }
  if (segment.numbers[2] == 0.0 && segment.numbers[7] == 0.0) segment.shape = Shape::link;
  return segment;
}

void put(const Value& value, int place, SheetColumn& column) {
  constexpr auto all_bits = ~std::uint64_t{0};
  column.constant[place] = value.constant, column.cos[place] = value.cos, column.sin[place] = value.sin;
  if (value.parameter < 0) return;
  column.parameter[place] = value.parameter;
  column.is_free[place] = std::bit_cast<double>(all_bits);
}

/// Puts the links that vary into sheets.
void fill_sheets(SegmentList& list) {
  std::vector<LinkSheet> sheets((list.segments.size() + links_per_sheet - 1) / links_per_sheet);
  for (std::size_t k = 0; k < list.segments.size(); ++k) {
    Segment& segment = list.segments[k];
    segment.in_sheet = segment.varies && segment.shape == Shape::link;
    list.is_all_in_sheets &= segment.in_sheet || !segment.varies;
    if (!segment.in_sheet) continue;
    LinkSheet& sheet = sheets[k / links_per_sheet];
    const auto place = static_cast<int>(k % links_per_sheet);
    put(segment.d, place, sheet.d), put(segment.a, place, sheet.a);
    put(segment.alpha, place, sheet.alpha), put(segment.theta, place, sheet.theta);
  }
  const auto in_sheet = [](const Segment& segment) { return segment.in_sheet; };
  if (std::any_of(list.segments.begin(), list.segments.end(), in_sheet)) list.sheets = std::move(sheets);
}

/// Merges a rotation and a translation along the same axis that follow each other into one screw.
struct ScrewWriter {
  ScrewPlan& plan;
  const std::vector<JointMotion>& joint_motions;
  std::vector<char> is_idle;                 // of each parameter: no screw writes its column
  bool has_turn = false, has_shift = false;  // of the last screw
  bool is_open = false;

  void rotate(const Mat3& rotation) {
    Screw screw{.is_rotation = true};
    for (int i = 0; i < 9; ++i) screw.rotation[i] = rotation(i / 3, i % 3);
    plan.screws.push_back(screw);
    is_open = false;
  }

  void move(const elementary::Factor& factor, const Value& value, int joint) {
    if (value.parameter < 0 && value.constant == 0.0 && !factor.moves) return;
    const bool turns = factor.motion == Motion::rotation;
    Screw& screw = screw_about(factor.axis, turns);
    (turns ? screw.angle : screw.length) = value;
    (turns ? has_turn : has_shift) = true;
    written(value);
    if (!factor.moves) return;
    const JointMotion& joint_motion = *std::find_if(joint_motions.begin(), joint_motions.end(),
                                                    [&](const JointMotion& m) { return m.joint == joint; });
    screw.move = joint_motion.move, screw.gain = joint_motion.gain, screw.slot = joint_motion.slot;
    written(joint_motion.gain);
  }

 private:
  Screw& screw_about(int axis, bool turns) {
    const bool fits = is_open && plan.screws.back().axis == axis && !(turns ? has_turn : has_shift);
    if (!fits) {
      plan.screws.push_back({.axis = axis});
      has_turn = has_shift = false, is_open = true;
    }
    return plan.screws.back();
  }
  void written(const Value& value) {
    if (value.parameter >= 0) is_idle[value.parameter] = false;
  }
};

std::vector<JointMotion> joint_motions_of(const Chain& chain, const Lookup& lookup) {
  const std::vector<int> q_index = active_joint_indices(chain);
  std::vector<JointMotion> list;
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    if (!has_position(joint.type)) continue;
    const bool turns = rotates(joint.type);
    JointMotion joint_motion{.joint = j,
                             .move = turns ? MotionKind::revolute : MotionKind::prismatic,
                             .gain = lookup.value(2 + j, Field::gain, joint.gain, Motion::translation),
                             .q_index = q_index[j]};
    for (const Coupling& c : joint.couplings) joint_motion.couplings.push_back({q_index[c.joint], c.factor});
    KINFER_EXPECT(joint_motion.gain.parameter < 0 || joint_motion.q_index >= 0,
                  "gain of joint {}, which has no joint position", j);
    if (joint_motion.gain.parameter >= 0)
      joint_motion.move = turns ? MotionKind::revolute_with_gain : MotionKind::prismatic_with_gain;
    list.push_back(std::move(joint_motion));
  }
  int slot = 0;
  for (auto motion = list.rbegin(); motion != list.rend(); ++motion) motion->slot = slot, slot += motion->slots();
  return list;
}

template <class Visitor>
void walk_joints_and_tool(const Chain& chain, const Lookup& lookup, Visitor& visit) {
  for (const int j : path_to(chain, chain.tip_joint())) walk(chain.joints[j], j, lookup, visit);
  walk(chain.tool, SetupFrame::tool, lookup, visit);
}

SegmentList segments_of(const Chain& nominal, const ParameterSet& set, const Lookup& lookup,
                        const std::vector<JointMotion>& joint_motions, BaseSide side) {
  SegmentList list;
  list.nominal = pack(set, nominal);
  list.angles = lookup.angles();
  FactorCollector collector;
  if (side == BaseSide::measurement && !lookup.frees_base()) {
    list.base = nominal.base.pose();
  } else {
    walk(nominal.base, SetupFrame::base, lookup, collector);
  }
  walk_joints_and_tool(nominal, lookup, collector);
  list.factors = std::move(collector.lists);
  for (const auto& factors : list.factors) list.segments.push_back(segment_of(factors));
  for (std::size_t k = 0; k < joint_motions.size(); ++k) {
    list.segments[k].move = joint_motions[k].move;
    list.segments[k].gain = joint_motions[k].gain;
    list.segments[k].slots_before = joint_motions[k].slot;
  }
  fill_sheets(list);
  return list;
}

ScrewPlan screws_of(const Chain& nominal, const ParameterSet& set, const Lookup& lookup,
                    const std::vector<JointMotion>& joint_motions) {
  ScrewPlan plan;
  ScrewWriter writer{plan, joint_motions, std::vector<char>(set.free_count(), true)};
  walk(nominal.base, SetupFrame::base, lookup, writer);
  walk_joints_and_tool(nominal, lookup, writer);
  for (std::size_t k = 0; k < writer.is_idle.size(); ++k)
    if (writer.is_idle[k]) plan.idle.push_back(static_cast<int>(k));
  return plan;
}

}  // namespace

int slots_of(const std::vector<JointMotion>& joint_motions) {
  return joint_motions.empty() ? 0 : joint_motions.front().slot + joint_motions.front().slots();
}

MatrixXd items_of(const std::vector<JointMotion>& joint_motions, const PointTable& points, const Pose& measured_from,
                  const Kernels& kernels) {
  const int slots = slots_of(joint_motions);
  MatrixXd items = MatrixXd::Zero(points.measured.cols(), slots + 3);
  VectorXd displacement(items.rows());
  for (const JointMotion& m : joint_motions) {
    displacement.setZero();
    if (m.q_index >= 0) displacement = m.gain.constant * points.joints.row(m.q_index);
    for (const Coupling& c : m.couplings) displacement += c.factor * points.joints.row(c.joint);
    if (m.move == MotionKind::revolute || m.move == MotionKind::revolute_with_gain) {
      kernels.sines(displacement.data(), static_cast<int>(displacement.size()), items.col(m.slot).data(),
                    items.col(m.slot + 1).data());
    } else {
      items.col(m.slot) = displacement;
    }
    if (m.slots() > 2) items.col(m.slot + 2) = points.joints.row(m.q_index);
  }
  const Mat3 rotated = measured_from.rotation.transpose();
  items.rightCols<3>() = (rotated * (points.measured.colwise() - measured_from.position)).transpose();
  return items;
}

std::vector<PointsAtTarget> points_by_target(const Chain& chain, const PointTable& points) {
  std::vector<PointsAtTarget> list(chain.targets.size() + 1);
  for (int i = 0; i < points.measured.cols(); ++i) {
    const int target = points.target.empty() ? -1 : points.target[i];
    list[target + 1].target = target;
    list[target + 1].points.push_back(i);
  }
  std::erase_if(list, [](const PointsAtTarget& at) { return at.points.empty(); });
  return list;
}

ChainPlan plan_of(const Chain& nominal, const ParameterSet& set, BaseSide side) {
  const Lookup lookup(set);
  ChainPlan plan{.joint_motions = joint_motions_of(nominal, lookup), .list = {}, .screws = {}};
  plan.list = segments_of(nominal, set, lookup, plan.joint_motions, side);
  if (side == BaseSide::chain) plan.screws = screws_of(nominal, set, lookup, plan.joint_motions);
  return plan;
}

Group group_at(const SegmentList& list, const Chain& nominal, int target) {
  Group group;
  const Vec3 on_tool = target < 0 ? Vec3::Zero().eval() : nominal.targets[target].xyz;
  for (int row = 0; row < 3; ++row) group.on_tool[row] = on_tool[row];
  if (list.segments.size() < 2) return group;
  const MotionKind last = list.segments[list.segments.size() - 2].move;
  const bool turns = last == MotionKind::revolute || last == MotionKind::revolute_with_gain;
  const auto is_along_axis = [](const Factor& f) { return f.kind != Factor::Kind::constant_rotation && f.axis == 2; };
  group.on_last_axis = turns && on_tool.x() == 0.0 && on_tool.y() == 0.0 &&
                       std::all_of(list.factors.back().begin(), list.factors.back().end(), is_along_axis);
  return group;
}

}  // namespace batch
}  // namespace kinfer
