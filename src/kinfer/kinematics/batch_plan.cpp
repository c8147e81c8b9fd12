#include "kinfer/kinematics/batch_plan.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/elementary.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

/// Moves by its reading and its couplings alone.
bool is_plain(const Joint& joint) {
  return joint.compliance == 0.0 && joint.torque_compliance == 0.0 && joint.backlash == 0.0 && joint.harmonics.empty();
}

bool is_geometry_or_gain(const Address& at) {
  return (at.owner == Owner::base || at.owner == Owner::joint || at.owner == Owner::tool) && at.field <= Field::gain;
}

}  // namespace

bool has_batch_form(const Chain& chain, const ParameterSet& set) {
  const auto free = set.free();
  return chain.expansion == 0.0 && chain.mountings.empty() &&
         std::all_of(chain.joints.begin(), chain.joints.end(), is_plain) &&
         std::all_of(free.begin(), free.end(), [](const Parameter* p) { return is_geometry_or_gain(p->at); });
}

namespace batch {
namespace {

using elementary::Motion;

bool is_angle(Field field) {
  constexpr std::array angles{Field::rx, Field::ry, Field::rz, Field::alpha, Field::theta, Field::beta};
  return std::find(angles.begin(), angles.end(), field) != angles.end();
}

/// Which parameter rules a number of the chain.
class Lookup {
 public:
  explicit Lookup(const ParameterSet& set) {
    for (const Parameter* p : set.free()) {
      angle_.push_back(is_angle(p->at.field) ? static_cast<int>(angles_.size()) : -1);
      if (is_angle(p->at.field)) angles_.push_back(static_cast<int>(addresses_.size()));
      addresses_.push_back(p->at);
      owners_ |= bit(p->at.owner), fields_ |= bit(p->at.field);
    }
  }

  Value value(const Address& at, double constant, Motion motion) const {
    Value value{.constant = constant};
    if (motion == Motion::turn && constant != 0.0) value.cos = std::cos(constant), value.sin = std::sin(constant);
    value.parameter = index_of(at);
    if (value.parameter >= 0) value.angle = angle_[value.parameter];
    return value;
  }
  bool frees(Owner owner) const { return owners_ & bit(owner); }
  const std::vector<int>& angles() const { return angles_; }

 private:
  template <class Enum>
  static std::uint32_t bit(Enum which) {
    return std::uint32_t{1} << static_cast<int>(which);
  }

  /// Who asks comes along the chain, and so do most sets: the search begins behind the last find.
  int index_of(const Address& at) const {
    if (!(owners_ & bit(at.owner)) || !(fields_ & bit(at.field))) return -1;
    const auto next = addresses_.begin() + next_;
    auto found = std::find(next, addresses_.end(), at);
    if (found == addresses_.end()) found = std::find(addresses_.begin(), next, at);
    if (found == next && (next == addresses_.end() || !(*next == at))) return -1;
    next_ = found - addresses_.begin() + 1;
    return static_cast<int>(next_ - 1);
  }

  std::vector<Address> addresses_;
  std::vector<int> angles_, angle_;        // of a parameter: which angle it is
  std::uint32_t owners_ = 0, fields_ = 0;  // a bit each
  mutable std::ptrdiff_t next_ = 0;
};

/// Calls visit(factor, value) for each turn and shift and visit(rotation) for each constant rotation on the way.
template <class Visitor>
struct Walker {
  const Lookup& lookup;
  Visitor& visit;
  Owner owner = Owner::base;
  int joint = -1;

  void operator()(const Mat3& rotation) {
    if (rotation != Mat3::Identity()) visit.rotate(rotation);
  }
  void operator()(const elementary::Factor& factor) {
    Address at{owner, joint};
    if (factor.field) at.field = *factor.field;
    visit.move(factor, factor.field ? lookup.value(at, factor.value, factor.motion) : Value{.constant = factor.value},
               joint);
  }
};

template <class Visitor>
void walk(const Frame& frame, Owner owner, const Lookup& lookup, Visitor& visit) {
  elementary::for_each_factor(frame, Walker<Visitor>{lookup, visit, owner, -1});
}
template <class Visitor>
void walk(const Joint& joint, int index, const Lookup& lookup, Visitor& visit) {
  elementary::for_each_factor(joint, Walker<Visitor>{lookup, visit, Owner::joint, index});
}

Factor rotation_factor(const Mat3& rotation) {
  Factor factor{.kind = Factor::Kind::rotation, .axis = 0, .value = {}, .rotation = {}};
  for (int i = 0; i < 9; ++i) factor.rotation[i] = rotation(i / 3, i % 3);
  return factor;
}

/// Gathers factors until a joint moves.
struct Collector {
  std::vector<std::vector<Factor>> lists{{}};

  Collector() { lists.back().reserve(usual); }

  void rotate(const Mat3& rotation) { lists.back().push_back(rotation_factor(rotation)); }
  void move(const elementary::Factor& factor, const Value& value, int) {
    const auto kind = factor.motion == Motion::turn ? Factor::Kind::turn : Factor::Kind::shift;
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
    if (f.kind == Factor::Kind::rotation) {
      pose.rotation *= Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(f.rotation);
    } else {
      elementary::apply(pose, f.kind == Factor::Kind::turn ? Motion::turn : Motion::shift, f.axis, f.value.constant);
    }
  }
  return pose;
}

/// TransZ(d) TransX(a) RotX(alpha) RotZ(theta), each at most once; what commutes may come in any order.
bool take_link(const std::vector<Factor>& factors, Segment& segment) {
  using enum Factor::Kind;
  int stage = 0;  // 0: before alpha, 1: after alpha, 2: after theta
  bool has_a = false, has_d = false;
  for (const Factor& f : factors) {
    if (f.kind == shift && f.axis == 2 && stage == 0 && !has_d) {
      segment.d = f.value, has_d = true;
    } else if (f.kind == shift && f.axis == 0 && stage <= 1 && !has_a) {
      segment.a = f.value, has_a = true;
    } else if (f.kind == turn && f.axis == 0 && stage == 0) {
      segment.alpha = f.value, stage = 1;
    } else if (f.kind == turn && f.axis == 2 && stage <= 1) {
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
    if (take_link(factors, segment)) segment.shape = Shape::link;
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

/// The links that vary, on their sheets.
void fill_sheets(SegmentList& list) {
  std::vector<LinkSheet> sheets((list.segments.size() + links_a_sheet - 1) / links_a_sheet);
  for (std::size_t k = 0; k < list.segments.size(); ++k) {
    Segment& segment = list.segments[k];
    segment.in_sheet = segment.varies && segment.shape == Shape::link;
    list.is_all_in_sheets &= segment.in_sheet || !segment.varies;
    if (!segment.in_sheet) continue;
    LinkSheet& sheet = sheets[k / links_a_sheet];
    const auto place = static_cast<int>(k % links_a_sheet);
    put(segment.d, place, sheet.d), put(segment.a, place, sheet.a);
    put(segment.alpha, place, sheet.alpha), put(segment.theta, place, sheet.theta);
  }
  const auto in_sheet = [](const Segment& segment) { return segment.in_sheet; };
  if (std::any_of(list.segments.begin(), list.segments.end(), in_sheet)) list.sheets = std::move(sheets);
}

/// Writes turns and shifts along one axis that follow each other as one screw.
struct ScrewWriter {
  ScrewPlan& plan;
  const std::vector<Movement>& movements;
  std::vector<char> is_idle;                 // of each parameter: nothing writes it
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
    const bool turns = factor.motion == Motion::turn;
    Screw& screw = screw_about(factor.axis, turns);
    (turns ? screw.turn : screw.shift) = value;
    (turns ? has_turn : has_shift) = true;
    written(value);
    if (!factor.moves) return;
    const Movement& movement =
        *std::find_if(movements.begin(), movements.end(), [&](const Movement& m) { return m.joint == joint; });
    screw.move = movement.move, screw.gain = movement.gain, screw.slot = movement.slot;
    written(movement.gain);
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

std::vector<Movement> movements_of(const Chain& chain, const Lookup& lookup) {
  const std::vector<int> reading = reading_indices(chain);
  std::vector<Movement> list;
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    if (joint.type == JointType::fixed) continue;
    const bool turns = joint.type == JointType::revolute;
    Movement movement{.joint = j,
                      .move = turns ? Move::turn : Move::shift,
                      .gain = lookup.value({Owner::joint, j, Field::gain}, joint.gain, Motion::shift),
                      .reading = reading[j]};
    for (const Coupling& c : joint.couplings) movement.couplings.push_back({reading[c.joint], c.factor});
    KINFER_EXPECT(movement.gain.parameter < 0 || movement.reading >= 0, "gain of joint {}, which has no reading", j);
    if (movement.gain.parameter >= 0) movement.move = turns ? Move::turn_by_gain : Move::shift_by_gain;
    list.push_back(std::move(movement));
  }
  int slot = 0;
  for (auto m = list.rbegin(); m != list.rend(); ++m) m->slot = slot, slot += m->slots();
  return list;
}

template <class Visitor>
void walk_joints_and_tool(const Chain& chain, const Lookup& lookup, Visitor& visit) {
  for (const int j : path_to(chain, chain.tip_joint())) walk(chain.joints[j], j, lookup, visit);
  walk(chain.tool, Owner::tool, lookup, visit);
}

SegmentList segments_of(const Chain& nominal, const ParameterSet& set, const Lookup& lookup,
                        const std::vector<Movement>& movements, BaseSide side) {
  SegmentList list;
  list.nominal = pack(set, nominal);
  list.angles = lookup.angles();
  Collector collector;
  if (side == BaseSide::measurement && !lookup.frees(Owner::base)) {
    list.base = nominal.base.pose();
  } else {
    walk(nominal.base, Owner::base, lookup, collector);
  }
  walk_joints_and_tool(nominal, lookup, collector);
  list.factors = std::move(collector.lists);
  for (const auto& factors : list.factors) list.segments.push_back(segment_of(factors));
  for (std::size_t k = 0; k < movements.size(); ++k) {
    list.segments[k].move = movements[k].move;
    list.segments[k].gain = movements[k].gain;
    list.segments[k].slots_before = movements[k].slot;
  }
  fill_sheets(list);
  return list;
}

ScrewPlan screws_of(const Chain& nominal, const ParameterSet& set, const Lookup& lookup,
                    const std::vector<Movement>& movements) {
  ScrewPlan plan;
  ScrewWriter writer{plan, movements, std::vector<char>(set.free_count(), true)};
  walk(nominal.base, Owner::base, lookup, writer);
  walk_joints_and_tool(nominal, lookup, writer);
  for (std::size_t k = 0; k < writer.is_idle.size(); ++k)
    if (writer.is_idle[k]) plan.idle.push_back(static_cast<int>(k));
  return plan;
}

}  // namespace

int slots_of(const std::vector<Movement>& movements) {
  return movements.empty() ? 0 : movements.front().slot + movements.front().slots();
}

MatrixXd items_of(const std::vector<Movement>& movements, const PointTable& points, const Pose& measured_from,
                  const Kernels& kernels) {
  const int slots = slots_of(movements);
  MatrixXd items = MatrixXd::Zero(points.measured.cols(), slots + 3);
  VectorXd moved(items.rows());
  for (const Movement& m : movements) {
    moved.setZero();
    if (m.reading >= 0) moved = m.gain.constant * points.joints.row(m.reading);
    for (const Coupling& c : m.couplings) moved += c.factor * points.joints.row(c.joint);
    if (m.move == Move::turn || m.move == Move::turn_by_gain) {
      kernels.sines(moved.data(), static_cast<int>(moved.size()), items.col(m.slot).data(),
                    items.col(m.slot + 1).data());
    } else {
      items.col(m.slot) = moved;
    }
    if (m.slots() > 2) items.col(m.slot + 2) = points.joints.row(m.reading);
  }
  const Mat3 turned = measured_from.rotation.transpose();
  items.rightCols<3>() = (turned * (points.measured.colwise() - measured_from.position)).transpose();
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
  ChainPlan plan{.movements = movements_of(nominal, lookup), .list = {}, .screws = {}};
  plan.list = segments_of(nominal, set, lookup, plan.movements, side);
  if (side == BaseSide::chain) plan.screws = screws_of(nominal, set, lookup, plan.movements);
  return plan;
}

Group group_at(const SegmentList& list, const Chain& nominal, int target) {
  Group group;
  const Vec3 on_tool = target < 0 ? Vec3::Zero().eval() : nominal.targets[target].xyz;
  for (int row = 0; row < 3; ++row) group.on_tool[row] = on_tool[row];
  if (list.segments.size() < 2) return group;
  const Move last = list.segments[list.segments.size() - 2].move;
  const bool turns = last == Move::turn || last == Move::turn_by_gain;
  const auto keeps_to_the_axis = [](const Factor& f) { return f.kind != Factor::Kind::rotation && f.axis == 2; };
  group.on_last_axis = turns && on_tool.x() == 0.0 && on_tool.y() == 0.0 &&
                       std::all_of(list.factors.back().begin(), list.factors.back().end(), keeps_to_the_axis);
  return group;
}

}  // namespace batch
}  // namespace kinfer
