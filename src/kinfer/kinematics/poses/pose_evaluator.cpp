// SPDX-License-Identifier: Apache-2.0
// PoseEvaluator: executes the step lists of program.hpp.
#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/poses/joint_factors.hpp"
#include "kinfer/kinematics/poses/pose_program.hpp"

namespace kinfer {
namespace {

using elementary::Motion;
using program::Scale;
using program::Step;
using program::StepList;

/// How one joint moves: displacement = gain · q[own] + Σ factor · q[coupled] + compliance · torque, and the deviations
/// (harmonics, measured torque, backlash) that few joints have.
struct JointMotionModel {
  double gain = 1.0;
  int q_index = -1;
  double compliance = 0.0;
  int coupling_begin = 0, coupling_end = 0;
  bool deviates = false;
  int wave_begin = 0;  // of its harmonics
};

/// Sine and cosine of a harmonic at a joint position.
struct Wave {
  double sine = 0.0, cosine = 1.0;
};

Wave wave_at(double angle) {
  Wave wave;
  ::sincos(angle, &wave.sine, &wave.cosine);
  return wave;
}

/// elementary::apply() with sine and cosine found at once, which takes half the time.
void rotate(Pose& pose, int axis, double angle) {
  const Wave wave = wave_at(angle);
  elementary::rotate(pose, axis, wave.cosine, wave.sine);
}

/// place_joint() without the sines and cosines of the joint's constant factors.
JointPlacement place(const Pose& parent, const JointFactors& joint, double displacement) {
  JointPlacement placed{.frame = parent * joint.before};
  if (!joint.moving) return placed;
  const elementary::Factor& moving = *joint.moving;
  placed.axis = placed.frame.rotation.col(moving.axis);
  placed.point = placed.frame.position;
  if (moving.motion == Motion::rotation)
    rotate(placed.frame, moving.axis, moving.value + displacement);
  else
    elementary::translate(placed.frame, moving.axis, moving.value + displacement);
  placed.frame = placed.frame * joint.after;
  return placed;
}

/// Joint positions and loads at one pose.
struct JointInputs {
  const double* q = nullptr;
  const double* torque = nullptr;  // of gravity, one per joint; null: none
  const Load* load = nullptr;
  const Wave* waves = nullptr;  // of all harmonics, in the order of the joints
};

}  // namespace

struct PoseEvaluator::Program {
  Chain chain;
  int active_count = 0, wave_count = 0;
  Eigen::Index columns = 0;
  StepList pose_only, recorded;
  std::vector<JointMotionModel> motion_models;  // in the order of the joints
  std::vector<JointFactors> factors;
  std::vector<Coupling> couplings;        // Coupling::joint is here an index into q
  std::vector<int> rotational, idle;      // columns that need the tool position; columns that are zero
  std::vector<ParameterAddress> address;  // of each column
  bool pose_needs_torque = false, derivative_needs_torque = false, has_expansion = false;
  VectorXd zero_torque;
  Mat3 base_rotation = Mat3::Identity();

  void set_chain(const Chain& source) {
    chain = source;
    base_rotation = chain.base.pose().rotation;
    active_count = dof(chain);
    zero_torque = VectorXd::Zero(static_cast<Eigen::Index>(chain.joints.size()));
    const std::vector<int> q_index = active_joint_indices(chain);
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      const Joint& joint = chain.joints[j];
      factors.emplace_back(joint);
      const int begin = static_cast<int>(couplings.size());
      for (const Coupling& c : joint.couplings) couplings.push_back({q_index[c.joint], c.factor});
      motion_models.push_back({joint.gain, q_index[j], joint.compliance, begin, static_cast<int>(couplings.size()),
                               joint.torque_compliance != 0.0 || joint.backlash != 0.0 || !joint.harmonics.empty(),
                               wave_count});
      wave_count += static_cast<int>(joint.harmonics.size());
      pose_needs_torque |= joint.compliance != 0.0;
    }
    pose_only = program::compile(chain, {});
  }

  void set_parameters(const ParameterSet& set) {
    std::vector<program::Column> wanted;
    derivative_needs_torque = pose_needs_torque;
    for (const Parameter* p : set.free()) {
      wanted.push_back({p->at, static_cast<int>(wanted.size())});
      address.push_back(p->at);
      derivative_needs_torque |= field_of(p->at) == Field::compliance;
    }
    columns = static_cast<Eigen::Index>(wanted.size());
    has_expansion = chain.expansion != 0.0 || std::ranges::count(address, ParameterAddress{ExpansionNumber{}}) > 0;
    recorded = program::compile(chain, wanted);
    std::vector<bool> acts(wanted.size(), false);
    for (const Step& step : recorded.steps) {
      if (step.kind != Step::Kind::record) continue;
      const bool by_joint_state =
          step.scale != Scale::one && step.scale != Scale::torque && step.scale != Scale::coupled;
      KINFER_EXPECT(!by_joint_state || motion_models[step.source].q_index >= 0,
                    "gain of joint {}, which has no joint position", step.source);
      const bool by_wave = step.scale == Scale::sine || step.scale == Scale::cosine;
      KINFER_EXPECT(!by_wave || step.term < std::ssize(chain.joints[step.source].harmonics),
                    "joint {} has no harmonic {}", step.source, step.term);
      acts[step.index] = true;
      if (step.motion == Motion::rotation) rotational.push_back(step.index);
    }
    for (std::size_t c = 0; c < acts.size(); ++c) {
      if (!acts[c]) idle.push_back(static_cast<int>(c));
    }
  }

  double deviation(int joint, const JointInputs& inputs) const {
    const Joint& of = chain.joints[joint];
    const int q_index = motion_models[joint].q_index;
    if (q_index < 0) return 0.0;
    double sum = of.torque_compliance * value_or_zero(inputs.load->torques, q_index) +
                 of.backlash * value_or_zero(inputs.load->approach, q_index);
    const Wave* wave = inputs.waves + motion_models[joint].wave_begin;
    for (const Harmonic& harmonic : of.harmonics) {
      sum += harmonic.sine * wave->sine + harmonic.cosine * wave->cosine;
      ++wave;
    }
    return sum;
  }

  /// Computed once for the displacements and the columns of a pose, into a buffer that is kept between calls.
  const Wave* waves(const double* q) const {
    if (wave_count == 0) return nullptr;
    thread_local std::vector<Wave> waves;
    waves.clear();
    for (std::size_t j = 0; j < motion_models.size(); ++j) {
      const JointMotionModel& model = motion_models[j];
      for (const Harmonic& harmonic : chain.joints[j].harmonics)
        waves.push_back(model.q_index >= 0 ? wave_at(harmonic.order * q[model.q_index]) : Wave{});
    }
    return waves.data();
  }

  const Wave& wave(const Step& step, const JointInputs& inputs) const {
    return inputs.waves[motion_models[step.source].wave_begin + step.term];
  }

  double displacement(int joint, const JointInputs& inputs) const {
    const JointMotionModel& model = motion_models[joint];
    double sum = model.q_index >= 0 ? model.gain * inputs.q[model.q_index] : 0.0;
    for (int c = model.coupling_begin; c < model.coupling_end; ++c)
      sum += couplings[c].factor * inputs.q[couplings[c].joint];
    if (model.deviates) sum += deviation(joint, inputs);
    return inputs.torque ? sum + model.compliance * inputs.torque[joint] : sum;
  }

  double scale(const Step& step, const JointInputs& inputs) const {
    if (step.scale == Scale::one) return 1.0;  // base and tool too, which belong to no joint
    const int q_index = motion_models[step.source].q_index;
    switch (step.scale) {
      case Scale::one:
        break;
      case Scale::torque:
        return inputs.torque[step.source];
      case Scale::joint_position:
        return inputs.q[q_index];
      case Scale::measured_torque:
        return value_or_zero(inputs.load->torques, q_index);
      case Scale::approach:
        return value_or_zero(inputs.load->approach, q_index);
      case Scale::sine:
        return wave(step, inputs).sine;
      case Scale::cosine:
        return wave(step, inputs).cosine;
      case Scale::coupled:
        return inputs.q[couplings[motion_models[step.source].coupling_begin + step.term].joint];
    }
    return 1.0;
  }

  /// Until the tool position is known, a rotational column holds a point of its axis above the axis.
  void record(const Step& step, const Pose& pose, double by, Twists& twists) const {
    auto column = twists.col(step.index);
    const Vec3 axis = by * pose.rotation.col(step.axis);
    if (step.motion == Motion::rotation) {
      column << pose.position, axis;
    } else {
      column << axis, Vec3::Zero();
    }
  }

  /// Pose of the tool, and position of the flange.
  struct ToolAndFlange {
    Pose pose;
    Vec3 flange = Vec3::Zero();
  };

  ToolAndFlange run(const StepList& list, const JointInputs& inputs, Twists* twists) const {
    ToolAndFlange result;
    Pose& pose = result.pose;
    for (const Step& step : list.steps) {
      switch (step.kind) {
        case Step::Kind::rotate:
          elementary::rotate(pose, step.axis, step.a, step.b);
          break;
        case Step::Kind::translate:
          elementary::translate(pose, step.axis, step.a);
          break;
        case Step::Kind::transform:
          pose = pose * list.constants[step.index];
          break;
        case Step::Kind::revolute_joint:
          rotate(pose, step.axis, step.a + displacement(step.index, inputs));
          break;
        case Step::Kind::prismatic_joint:
          elementary::translate(pose, step.axis, step.a + displacement(step.index, inputs));
          break;
        case Step::Kind::record:
          record(step, pose, scale(step, inputs), *twists);
          break;
        case Step::Kind::flange:
          result.flange = pose.position;
          break;
      }
    }
    return result;
  }

  /// Gravity torques of the undeflected chain; the buffers are kept between calls.
  const double* gravity(const double* q, const Load& load) const {
    if (!load.gravity.empty()) return load.gravity.data();
    if (load.payload == 0.0 && chain.masses.empty()) return zero_torque.data();
    thread_local std::vector<JointPlacement> placed;
    thread_local VectorXd torques;
    placed.resize(chain.joints.size());
    const Pose base = chain.base.pose();
    Load payload_only;
    payload_only.payload = load.payload;
    for (std::size_t j = 0; j < placed.size(); ++j) {
      const JointMotionModel& model = motion_models[j];
      double by = model.q_index >= 0 ? model.gain * q[model.q_index] : 0.0;
      for (int c = model.coupling_begin; c < model.coupling_end; ++c) by += couplings[c].factor * q[couplings[c].joint];
      const int parent = chain.joints[j].parent;
      placed[j] = place(parent >= 0 ? placed[parent].frame : base, factors[j], by);
    }
    gravity_torques(chain, placed, payload_only, torques);
    return torques.data();
  }

  ToolAndFlange run(const StepList& list, ConstVectorRef q, const Load& load, bool needs_torque, Twists* twists) const {
    KINFER_EXPECT(q.size() == active_count, "{} joint positions for {} joints that have one", q.size(), active_count);
    return run(list, {q.data(), needs_torque ? gravity(q.data(), load) : nullptr, &load, waves(q.data())}, twists);
  }

  /// Displacement of the tool by thermal expansion of the robot's lengths.
  Vec3 thermal_displacement(const ToolAndFlange& result, const Load& load) const {
    return chain.expansion * load.temperature_rise * (result.flange - chain.base.xyz);
  }

  /// Displacement of the tool by the chain's field.
  Vec3 field_displacement(ConstVectorRef q) const { return base_rotation * displacement_at(chain.field, q); }

  /// Thermal expansion of the columns: those of joints scale with the lengths, those of the tool move with the flange.
  void expand_columns(const ToolAndFlange& result, const Load& load, Twists& twists) const {
    const double by = chain.expansion * load.temperature_rise;
    const Vec3 base = chain.base.xyz, shift = thermal_displacement(result, load);
    std::vector<bool> turns(address.size(), false);
    for (const int c : rotational) turns[c] = true;
    for (std::size_t c = 0; c < address.size(); ++c) {
      auto origin = twists.col(static_cast<Eigen::Index>(c)).head<3>();
      if (is_joint_parameter(address[c])) turns[c] ? origin += by * (origin - base).eval() : origin *= 1.0 + by;
      if (is_own_frame_parameter(address[c], SetupFrame::tool) && turns[c]) origin += shift;
      if (std::holds_alternative<ExpansionNumber>(address[c])) origin = load.temperature_rise * (result.flange - base);
    }
  }
};

PoseEvaluator::PoseEvaluator(const Chain& chain, const ParameterSet& set) : program_(std::make_unique<Program>()) {
  expect_well_formed(chain);
  program_->set_chain(chain);
  program_->set_parameters(set);
}

PoseEvaluator::~PoseEvaluator() = default;
PoseEvaluator::PoseEvaluator(PoseEvaluator&&) noexcept = default;

Pose PoseEvaluator::pose(ConstVectorRef q, const Load& load) const {
  auto result = program_->run(program_->pose_only, q, load, program_->pose_needs_torque, nullptr);
  if (program_->chain.expansion != 0.0) result.pose.position += program_->thermal_displacement(result, load);
  if (!program_->chain.field.empty()) result.pose.position += program_->field_displacement(q);
  return result.pose;
}

Pose PoseEvaluator::pose_and_derivative(ConstVectorRef q, const Load& load, Twists& twists) const {
  twists.resize(6, program_->columns);
  auto result = program_->run(program_->recorded, q, load, program_->derivative_needs_torque, &twists);
  for (const int c : program_->idle) twists.col(c).setZero();
  if (program_->has_expansion) {
    program_->expand_columns(result, load, twists);
    result.pose.position += program_->thermal_displacement(result, load);
  }
  const bool has_field = !program_->chain.field.empty();
  const Vec3 displacement = has_field ? program_->field_displacement(q) : Vec3::Zero().eval();
  for (const int c : program_->rotational) {
    const Vec3 axis = twists.col(c).tail<3>();
    Vec3 lever = result.pose.position - twists.col(c).head<3>();
    // The field turns with the base, and with nothing else.
    if (has_field && is_own_frame_parameter(program_->address[c], SetupFrame::base)) lever += displacement;
    twists.col(c).head<3>() = axis.cross(lever);
  }
  result.pose.position += displacement;
  return result.pose;
}

}  // namespace kinfer
