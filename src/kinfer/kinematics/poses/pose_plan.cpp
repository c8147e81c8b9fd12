// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/poses/pose_plan.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/poses/joint_factors.hpp"
#include "kinfer/kinematics/poses/pose_program.hpp"

namespace kinfer::batch {
namespace {

using elementary::Motion;

LoadedJoint loaded_joint(const Joint& joint) {
  const JointFactors factors(joint);
  LoadedJoint loaded{.parent = joint.parent};
  write_rows(factors.before, loaded.before), write_rows(factors.after, loaded.after);
  if (factors.moving) {
    loaded.move =
        factors.moving->motion == Motion::rotation ? LoadedJoint::Move::rotation : LoadedJoint::Move::translation;
    loaded.axis = factors.moving->axis, loaded.offset = factors.moving->value;
  }
  return loaded;
}

/// Harmonics of orders 0, 1, 2, … without a gap, which cost less than as many waves.
std::size_t series_length(const std::vector<Harmonic>& harmonics) {
  constexpr std::size_t least_length = 4;
  std::size_t length = 0;
  while (length < harmonics.size() && harmonics[length].order == static_cast<double>(length)) ++length;
  return length < least_length ? 0 : length;
}

PoseStep::Kind kind_of(const program::Step& step) {
  using Kind = PoseStep::Kind;
  using Step = program::Step;
  switch (step.kind) {
    case Step::Kind::rotate:
      return Kind::rotate;
    case Step::Kind::translate:
      return Kind::translate;
    case Step::Kind::transform:
      return Kind::transform;
    case Step::Kind::revolute_joint:
      return Kind::revolute_joint;
    case Step::Kind::prismatic_joint:
      return Kind::prismatic_joint;
    case Step::Kind::record:
      return step.motion == elementary::Motion::rotation ? Kind::record_rotation : Kind::record_translation;
    case Step::Kind::flange:
      return Kind::flange;
  }
  return Kind::flange;
}

Stretch stretch_of(const ParameterAddress& at) {
  if (is_joint_parameter(at)) return Stretch::joint;
  if (is_own_frame_parameter(at, SetupFrame::tool)) return Stretch::tool;
  return std::holds_alternative<ExpansionNumber>(at) ? Stretch::is_the_expansion : Stretch::none;
}

class Planner {
 public:
  Planner(const Chain& chain, const ParameterSet& set) : chain_(chain), q_index_(active_joint_indices(chain)) {
    for (const Parameter* p : set.free()) address_.push_back(p->at);
  }

  PosePlan run() {
    lay_out();
    plan_joints();
    plan_gravity();
    std::vector<program::Column> wanted;
    for (const ParameterAddress& at : address_) {
      wanted.push_back({at, static_cast<int>(wanted.size())});
      plan_.columns.push_back({.stretch = stretch_of(at)});
    }
    plan_.pose_steps = steps_of(program::compile(chain_, {}));
    plan_.recorded_steps = steps_of(program::compile(chain_, wanted));
    return std::move(plan_);
  }

 private:
  bool is_free(Field field) const {
    return std::ranges::any_of(address_, [&](const ParameterAddress& at) { return field_of(at) == field; });
  }
  template <class Has>
  bool any_joint(Has has) const {
    return std::ranges::any_of(chain_.joints, has);
  }

  void lay_out() {
    plan_.layout.dof = dof(chain_);
    plan_.layout.append(plan_.layout.dof);
    if (is_free(Field::torque_compliance) || any_joint([](const Joint& j) { return j.torque_compliance != 0.0; }))
      plan_.layout.torques = plan_.layout.append(plan_.layout.dof);
    if (is_free(Field::backlash) || any_joint([](const Joint& j) { return j.backlash != 0.0; }))
      plan_.layout.approach = plan_.layout.append(plan_.layout.dof);
    if (is_free(Field::compliance) || any_joint([](const Joint& j) { return j.compliance != 0.0; })) {
      plan_.layout.gravity = plan_.layout.append(static_cast<int>(chain_.joints.size()));
      plan_.layout.payload = plan_.layout.append(1);
    }
    if (chain_.expansion != 0.0 || std::ranges::count(address_, ParameterAddress{ExpansionNumber{}}) > 0)
      plan_.layout.rise = plan_.layout.append(1);
  }

  /// The numbers that a harmonic's sine and cosine are written to.
  int wave_slot(double order, int angle) {
    const auto known =
        std::ranges::find_if(plan_.waves, [&](const Wave& wave) { return wave.order == order && wave.angle == angle; });
    if (known != plan_.waves.end()) return known->slot;
    return plan_.waves.emplace_back(Wave{order, angle, plan_.layout.append(2)}).slot;
  }

  void plan_joints() {
    plan_.coefficients.reserve(2 * chain_.joints.size());
    for (std::size_t j = 0; j < chain_.joints.size(); ++j) {
      const Joint& joint = chain_.joints[j];
      const int own = q_index_[j];
      JointDisplacement& moves = plan_.joints.emplace_back();
      LoadedJoint& carries = plan_.loaded.emplace_back(loaded_joint(joint));
      moves.first = carries.first = static_cast<int>(plan_.terms.size());
      if (own >= 0) plan_.terms.push_back({joint.gain, own});
      for (const Coupling& c : joint.couplings) plan_.terms.push_back({c.factor, q_index_[c.joint]});
      carries.end = static_cast<int>(plan_.terms.size());
      if (plan_.layout.gravity >= 0)
        plan_.terms.push_back({joint.compliance, plan_.layout.gravity + static_cast<int>(j)});
      if (own >= 0) add_deviations(joint, own, moves);
      moves.end = static_cast<int>(plan_.terms.size());
    }
  }

  void add_deviations(const Joint& joint, int own, JointDisplacement& moves) {
    if (joint.torque_compliance != 0.0) plan_.terms.push_back({joint.torque_compliance, plan_.layout.torques + own});
    if (joint.backlash != 0.0) plan_.terms.push_back({joint.backlash, plan_.layout.approach + own});
    const std::size_t series = series_length(joint.harmonics);
    for (std::size_t k = series; k < joint.harmonics.size(); ++k) {
      const int slot = wave_slot(joint.harmonics[k].order, own);
      plan_.terms.push_back({joint.harmonics[k].sine, slot});
      plan_.terms.push_back({joint.harmonics[k].cosine, slot + 1});
    }
    if (series == 0) return;
    std::vector<double>&sines = plan_.coefficients.emplace_back(), &cosines = plan_.coefficients.emplace_back();
    for (std::size_t k = 0; k < series; ++k)
      sines.push_back(joint.harmonics[k].sine), cosines.push_back(joint.harmonics[k].cosine);
    moves.harmonics = static_cast<int>(series), moves.angle = own;
    moves.sines = sines.data(), moves.cosines = cosines.data();
  }

  void plan_gravity() {
    if (plan_.layout.gravity < 0) return;
    for (const PointMass& m : chain_.masses)
      plan_.masses.push_back({.joint = m.joint, .at = {m.com.x(), m.com.y(), m.com.z()}, .mass = m.mass});
    if (const int tip = chain_.tip_joint(); tip >= 0) {
      const Vec3 tool = chain_.tool.pose().position;
      plan_.masses.push_back({.joint = tip, .at = {tool.x(), tool.y(), tool.z()}, .number = plan_.layout.payload});
    }
  }

  /// The number that a recorded column is multiplied by.
  int scale_of(const program::Step& step) {
    if (step.scale == program::Scale::one) return -1;
    if (step.scale == program::Scale::torque) return plan_.layout.gravity + step.source;
    const Joint& joint = chain_.joints[step.source];
    if (step.scale == program::Scale::coupled) return q_index_[joint.couplings[step.term].joint];
    const int own = q_index_[step.source];
    KINFER_EXPECT(own >= 0, "a gain or deviation of joint {}, which has no joint position", step.source);
    if (step.scale == program::Scale::measured_torque) return plan_.layout.torques + own;
    if (step.scale == program::Scale::approach) return plan_.layout.approach + own;
    if (step.scale == program::Scale::joint_position) return own;
    KINFER_EXPECT(step.term < std::ssize(joint.harmonics), "joint {} has no harmonic {}", step.source, step.term);
    return wave_slot(joint.harmonics[step.term].order, own) + (step.scale == program::Scale::cosine ? 1 : 0);
  }

  std::vector<PoseStep> steps_of(const program::StepList& list) {
    const auto first_constant = static_cast<int>(plan_.constants.size() / 12);
    for (const Pose& constant : list.constants) {
      plan_.constants.resize(plan_.constants.size() + 12);
      write_rows(constant, plan_.constants.data() + plan_.constants.size() - 12);
    }
    std::vector<PoseStep> steps;
    for (const program::Step& step : list.steps) {
      PoseStep& added = steps.emplace_back(
          PoseStep{.kind = kind_of(step), .axis = step.axis, .index = step.index, .a = step.a, .b = step.b});
      if (step.kind == program::Step::Kind::transform) added.index += first_constant;
      if (step.kind != program::Step::Kind::record) continue;
      added.scale = scale_of(step);
      plan_.columns[step.index].acts = true;
      plan_.columns[step.index].rotates = step.motion == elementary::Motion::rotation;
    }
    return steps;
  }

  const Chain& chain_;
  std::vector<int> q_index_;
  std::vector<ParameterAddress> address_;  // of each column
  PosePlan plan_;
};

}  // namespace

void write_rows(const Pose& pose, double* to) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) to[4 * row + column] = pose.rotation(row, column);
    to[4 * row + 3] = pose.position[row];
  }
}

PosePlan pose_plan_of(const Chain& chain, const ParameterSet& set) {
  return Planner(chain, set).run();
}

}  // namespace kinfer::batch
