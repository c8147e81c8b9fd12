#include "kinfer/kinematics/batch_plan.hpp"

#include <algorithm>
#include <cmath>

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

Value value_of(int parameter, double constant) {
  return {parameter, constant, std::cos(constant), std::sin(constant)};
}

/// Which parameter rules a number of the chain.
class Lookup {
 public:
  explicit Lookup(const ParameterSet& set) {
    for (const Parameter* p : set.free()) addresses_.push_back(p->at);
  }

  Value value(const Address& at, double constant) const {
    const auto found = std::find(addresses_.begin(), addresses_.end(), at);
    return value_of(found == addresses_.end() ? -1 : static_cast<int>(found - addresses_.begin()), constant);
  }
  bool frees(Owner owner) const {
    return std::any_of(addresses_.begin(), addresses_.end(), [&](const Address& at) { return at.owner == owner; });
  }

 private:
  std::vector<Address> addresses_;
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
    const Value value =
        factor.field ? lookup.value({owner, joint, *factor.field}, factor.value) : value_of(-1, factor.value);
    visit.move(factor, value, joint);
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

  void rotate(const Mat3& rotation) { lists.back().push_back(rotation_factor(rotation)); }
  void move(const elementary::Factor& factor, const Value& value, int) {
    const auto kind = factor.motion == Motion::turn ? Factor::Kind::turn : Factor::Kind::shift;
    if (value.parameter >= 0 || value.constant != 0.0)
      lists.back().push_back({.kind = kind, .axis = factor.axis, .value = value, .rotation = {}});
    if (!factor.moves) return;
    KINFER_EXPECT(factor.axis == 2, "every convention moves about or along z");
    lists.emplace_back();
  }
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

/// Writes down each turn and shift, and before it whose number it is.
struct StepWriter {
  StepPlan& plan;
  const Lookup& lookup;
  const std::vector<Movement>& movements;
  const Chain& chain;

  void rotate(const Mat3& rotation) {
    Step step{.kind = Step::Kind::rotation};
    for (int i = 0; i < 9; ++i) step.rotation[i] = rotation(i / 3, i % 3);
    add(step, {}, {});
  }

  void move(const elementary::Factor& factor, const Value& value, int joint) {
    record(factor, value.parameter, -1);
    if (!factor.moves) {
      if (value.parameter >= 0 || value.constant != 0.0)
        add({.kind = factor.motion == Motion::turn ? Step::Kind::turn : Step::Kind::shift, .axis = factor.axis}, value,
            {});
      return;
    }
    const Movement& movement =
        *std::find_if(movements.begin(), movements.end(), [&](const Movement& m) { return m.joint == joint; });
    record(factor, movement.gain.parameter, movement.slot + 2);
    const auto kind = factor.motion == Motion::turn ? Step::Kind::turn_joint : Step::Kind::shift_joint;
    add({.kind = kind, .axis = factor.axis, .slot = movement.slot}, value, movement.gain);
  }

 private:
  void add(const Step& step, const Value& value, const Value& gain) {
    plan.steps.push_back(step);
    plan.values.push_back(value);
    plan.gains.push_back(gain);
  }
  void record(const elementary::Factor& factor, int parameter, int slot) {
    if (parameter < 0) return;
    const auto kind = factor.motion == Motion::turn ? Step::Kind::record_turn : Step::Kind::record_shift;
    add({.kind = kind, .axis = factor.axis, .slot = slot, .column = parameter}, {}, {});
    std::erase(plan.idle, parameter);
  }
};

double number(const Value& value, ConstVectorRef x) {
  return value.parameter < 0 ? value.constant : x[value.parameter];
}

}  // namespace

std::vector<Movement> movements_of(const Chain& chain, const ParameterSet& set) {
  const Lookup lookup(set);
  const std::vector<int> reading = reading_indices(chain);
  std::vector<Movement> list;
  for (const int j : path_to(chain, chain.tip_joint())) {
    const Joint& joint = chain.joints[j];
    if (joint.type == JointType::fixed) continue;
    const bool turns = joint.type == JointType::revolute;
    Movement movement{.joint = j,
                      .move = turns ? Move::turn : Move::shift,
                      .gain = lookup.value({Owner::joint, j, Field::gain}, joint.gain),
                      .reading = reading[j]};
    for (const Coupling& c : joint.couplings) movement.couplings.push_back({reading[c.joint], c.factor});
    KINFER_EXPECT(movement.gain.parameter < 0 || movement.reading >= 0, "gain of joint {}, which has no reading", j);
    if (movement.gain.parameter >= 0) movement.move = turns ? Move::turn_by_gain : Move::shift_by_gain;
    list.push_back(movement);
  }
  int slot = 0;
  for (auto m = list.rbegin(); m != list.rend(); ++m) m->slot = slot, slot += m->slots();
  return list;
}

int slots_of(const std::vector<Movement>& movements) {
  return movements.empty() ? 0 : movements.front().slot + movements.front().slots();
}

void write_item(const std::vector<Movement>& movements, const double* q, const Vec3& measured, std::span<double> item) {
  for (const Movement& m : movements) {
    double moved = m.reading >= 0 ? m.gain.constant * q[m.reading] : 0.0;
    for (const Coupling& c : m.couplings) moved += c.factor * q[c.joint];
    const bool turns = m.move == Move::turn || m.move == Move::turn_by_gain;
    item[m.slot] = turns ? std::cos(moved) : moved;
    if (m.slots() > 1) item[m.slot + 1] = turns ? std::sin(moved) : 0.0;
    if (m.slots() > 2) item[m.slot + 2] = q[m.reading];
  }
  for (int row = 0; row < 3; ++row) item[slots_of(movements) + row] = measured[row];
}

SegmentList segments_of(const Chain& nominal, const ParameterSet& set, BaseSide side) {
  const Lookup lookup(set);
  SegmentList list;
  list.nominal = pack(set, nominal);
  Collector collector;
  if (side == BaseSide::measurement && !lookup.frees(Owner::base)) {
    list.base = nominal.base.pose();
  } else {
    walk(nominal.base, Owner::base, lookup, collector);
  }
  for (const int j : path_to(nominal, nominal.tip_joint())) walk(nominal.joints[j], j, lookup, collector);
  walk(nominal.tool, Owner::tool, lookup, collector);
  list.factors = std::move(collector.lists);
  for (const auto& factors : list.factors) list.segments.push_back(segment_of(factors));
  const std::vector<Movement> movements = movements_of(nominal, set);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    list.segments[k].move = movements[k].move;
    list.segments[k].gain = movements[k].gain;
    list.segments[k].slots_before = movements[k].slot;
  }
  return list;
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

StepPlan steps_of(const Chain& nominal, const ParameterSet& set) {
  const Lookup lookup(set);
  const std::vector<Movement> movements = movements_of(nominal, set);
  StepPlan plan;
  for (int k = 0; k < set.free_count(); ++k) plan.idle.push_back(k);
  StepWriter writer{plan, lookup, movements, nominal};
  walk(nominal.base, Owner::base, lookup, writer);
  for (const int j : path_to(nominal, nominal.tip_joint())) walk(nominal.joints[j], j, lookup, writer);
  walk(nominal.tool, Owner::tool, lookup, writer);
  return plan;
}

std::vector<Step> StepPlan::at(ConstVectorRef x) const {
  std::vector<Step> now = steps;
  for (std::size_t i = 0; i < now.size(); ++i) {
    Step& step = now[i];
    const double value = number(values[i], x);
    if (step.kind == Step::Kind::turn || step.kind == Step::Kind::turn_joint) {
      step.a = std::cos(value), step.b = std::sin(value);
    } else {
      step.a = value;
    }
    if (gains[i].parameter >= 0) step.extra_gain = x[gains[i].parameter] - gains[i].constant;
  }
  return now;
}

}  // namespace batch
}  // namespace kinfer
