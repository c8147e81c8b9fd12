// PoseEvaluator: runs the step lists of program.hpp.
#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/program.hpp"

namespace kinfer {
namespace {

using elementary::Motion;
using program::Scale;
using program::Step;
using program::StepList;

/// How one joint moves: moved = gain · q[reading] + Σ factor · q[coupling] + compliance · torque, and the deviations
/// that few joints have.
struct Mover {
  double gain = 1.0;
  int reading = -1;
  double compliance = 0.0;
  int coupling_begin = 0, coupling_end = 0;
  bool deviates = false;
};

/// All that makes one joint move at one pose.
struct Drive {
  const double* q = nullptr;
  const double* torque = nullptr;  // of gravity, one a joint; null: none
  const Load* load = nullptr;
};

}  // namespace

struct PoseEvaluator::Program {
  Chain chain;
  int readings = 0;
  Eigen::Index columns = 0;
  StepList pose_only, recorded;
  std::vector<Mover> movers;        // in the order of the joints
  std::vector<Coupling> couplings;  // Coupling::joint is here an index into q
  std::vector<int> turning, idle;   // columns that need the tool's position; columns that nothing moves
  std::vector<Owner> owner;         // of each column
  bool pose_needs_torque = false, derivative_needs_torque = false, grows = false;
  VectorXd no_torque;

  void take_chain(const Chain& taken) {
    chain = taken;
    readings = dof(chain);
    no_torque = VectorXd::Zero(static_cast<Eigen::Index>(chain.joints.size()));
    const std::vector<int> reading = reading_indices(chain);
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      const Joint& joint = chain.joints[j];
      const int begin = static_cast<int>(couplings.size());
      for (const Coupling& c : joint.couplings) couplings.push_back({reading[c.joint], c.factor});
      movers.push_back({joint.gain, reading[j], joint.compliance, begin, static_cast<int>(couplings.size()),
                        joint.torque_compliance != 0.0 || joint.backlash != 0.0 || !joint.harmonics.empty()});
      pose_needs_torque |= joint.compliance != 0.0;
    }
    pose_only = program::compile(chain, {});
  }

  void take_parameters(const ParameterSet& set) {
    std::vector<program::Column> wanted;
    derivative_needs_torque = pose_needs_torque;
    for (const Parameter* p : set.free()) {
      wanted.push_back({p->at, static_cast<int>(wanted.size())});
      owner.push_back(p->at.owner);
      derivative_needs_torque |= p->at.field == Field::compliance;
    }
    columns = static_cast<Eigen::Index>(wanted.size());
    grows = chain.expansion != 0.0 || std::find(owner.begin(), owner.end(), Owner::robot) != owner.end();
    recorded = program::compile(chain, wanted);
    std::vector<bool> acts(wanted.size(), false);
    for (const Step& step : recorded.steps) {
      if (step.kind != Step::Kind::record) continue;
      const bool by_reading = step.scale != Scale::one && step.scale != Scale::torque && step.scale != Scale::coupled;
      KINFER_EXPECT(!by_reading || movers[step.source].reading >= 0, "gain of joint {}, which has no reading",
                    step.source);
      acts[step.index] = true;
      if (step.motion == Motion::turn) turning.push_back(step.index);
    }
    for (std::size_t c = 0; c < acts.size(); ++c) {
      if (!acts[c]) idle.push_back(static_cast<int>(c));
    }
  }

  double deviation(int joint, const Drive& drive) const {
    const Joint& of = chain.joints[joint];
    const int reading = movers[joint].reading;
    if (reading < 0) return 0.0;
    double sum = of.torque_compliance * value_or_zero(drive.load->torques, reading) +
                 of.backlash * value_or_zero(drive.load->approach, reading);
    for (const Harmonic& h : of.harmonics)
      sum += h.sine * std::sin(h.order * drive.q[reading]) + h.cosine * std::cos(h.order * drive.q[reading]);
    return sum;
  }

  double moved(int joint, const Drive& drive) const {
    const Mover& mover = movers[joint];
    double sum = mover.reading >= 0 ? mover.gain * drive.q[mover.reading] : 0.0;
    for (int c = mover.coupling_begin; c < mover.coupling_end; ++c)
      sum += couplings[c].factor * drive.q[couplings[c].joint];
    if (mover.deviates) sum += deviation(joint, drive);
    return drive.torque ? sum + mover.compliance * drive.torque[joint] : sum;
  }

  double scale(const Step& step, const Drive& drive) const {
    if (step.scale == Scale::one) return 1.0;  // of base and tool too, which no joint moves
    const int reading = movers[step.source].reading;
    switch (step.scale) {
      case Scale::one:
        break;
      case Scale::torque:
        return drive.torque[step.source];
      case Scale::reading:
        return drive.q[reading];
      case Scale::measured_torque:
        return value_or_zero(drive.load->torques, reading);
      case Scale::approach:
        return value_or_zero(drive.load->approach, reading);
      case Scale::sine:
        return std::sin(step.a * drive.q[reading]);
      case Scale::cosine:
        return std::cos(step.a * drive.q[reading]);
      case Scale::coupled:
        return drive.q[couplings[movers[step.source].coupling_begin + step.term].joint];
    }
    return 1.0;
  }

  /// Until the tool's position is known, a turning column holds its origin above its axis.
  void record(const Step& step, const Pose& pose, double by, Twists& twists) const {
    auto column = twists.col(step.index);
    const Vec3 axis = by * pose.rotation.col(step.axis);
    if (step.motion == Motion::turn) {
      column << pose.position, axis;
    } else {
      column << axis, Vec3::Zero();
    }
  }

  /// The tool's pose, and where the joints end.
  struct Walked {
    Pose pose;
    Vec3 flange = Vec3::Zero();
  };

  Walked run(const StepList& list, const Drive& drive, Twists* twists) const {
    Walked walked;
    Pose& pose = walked.pose;
    for (const Step& step : list.steps) {
      switch (step.kind) {
        case Step::Kind::turn:
          elementary::turn(pose, step.axis, step.a, step.b);
          break;
        case Step::Kind::shift:
          elementary::shift(pose, step.axis, step.a);
          break;
        case Step::Kind::transform:
          pose = pose * list.constants[step.index];
          break;
        case Step::Kind::turn_joint:
          elementary::apply(pose, Motion::turn, step.axis, step.a + moved(step.index, drive));
          break;
        case Step::Kind::shift_joint:
          elementary::shift(pose, step.axis, step.a + moved(step.index, drive));
          break;
        case Step::Kind::record:
          record(step, pose, scale(step, drive), *twists);
          break;
        case Step::Kind::flange:
          walked.flange = pose.position;
          break;
      }
    }
    return walked;
  }

  /// Torques of gravity on the undeflected chain; the buffers are kept between calls.
  const double* gravity(const double* q, const Load& load) const {
    if (!load.gravity.empty()) return load.gravity.data();
    if (load.payload == 0.0 && chain.masses.empty()) return no_torque.data();
    thread_local std::vector<PlacedJoint> placed;
    thread_local VectorXd torques;
    placed.resize(chain.joints.size());
    const Pose base = chain.base.pose();
    Load payload_only;
    payload_only.payload = load.payload;
    for (std::size_t j = 0; j < placed.size(); ++j) {
      const Mover& mover = movers[j];
      double by = mover.reading >= 0 ? mover.gain * q[mover.reading] : 0.0;
      for (int c = mover.coupling_begin; c < mover.coupling_end; ++c) by += couplings[c].factor * q[couplings[c].joint];
      const Joint& joint = chain.joints[j];
      placed[j] = place(joint.parent >= 0 ? placed[joint.parent].frame : base, joint, by);
    }
    gravity_torques(chain, placed, payload_only, torques);
    return torques.data();
  }

  Walked run(const StepList& list, ConstVectorRef q, const Load& load, bool needs_torque, Twists* twists) const {
    KINFER_EXPECT(q.size() == readings, "{} readings for {} joints that have one", q.size(), readings);
    return run(list, {q.data(), needs_torque ? gravity(q.data(), load) : nullptr, &load}, twists);
  }

  /// How much the robot's lengths add to the tool's position by being warm.
  Vec3 growth(const Walked& walked, const Load& load) const {
    return chain.expansion * load.warming * (walked.flange - chain.base.xyz);
  }

  /// The columns of the joints grow with the lengths, those of the tool move with the flange.
  void grow(const Walked& walked, const Load& load, Twists& twists) const {
    const double by = chain.expansion * load.warming;
    const Vec3 base = chain.base.xyz, shift = growth(walked, load);
    std::vector<bool> turns(owner.size(), false);
    for (const int c : turning) turns[c] = true;
    for (std::size_t c = 0; c < owner.size(); ++c) {
      auto origin = twists.col(static_cast<Eigen::Index>(c)).head<3>();
      if (owner[c] == Owner::joint) turns[c] ? origin += by * (origin - base).eval() : origin *= 1.0 + by;
      if (owner[c] == Owner::tool && turns[c]) origin += shift;
      if (owner[c] == Owner::robot) origin = load.warming * (walked.flange - base);
    }
  }
};

PoseEvaluator::PoseEvaluator(const Chain& chain, const ParameterSet& set) : program_(std::make_unique<Program>()) {
  expect_well_formed(chain);
  program_->take_chain(chain);
  program_->take_parameters(set);
}

PoseEvaluator::~PoseEvaluator() = default;
PoseEvaluator::PoseEvaluator(PoseEvaluator&&) noexcept = default;

Pose PoseEvaluator::pose(ConstVectorRef q, const Load& load) const {
  auto walked = program_->run(program_->pose_only, q, load, program_->pose_needs_torque, nullptr);
  if (program_->chain.expansion != 0.0) walked.pose.position += program_->growth(walked, load);
  return walked.pose;
}

Pose PoseEvaluator::pose_and_derivative(ConstVectorRef q, const Load& load, Twists& twists) const {
  twists.resize(6, program_->columns);
  auto walked = program_->run(program_->recorded, q, load, program_->derivative_needs_torque, &twists);
  for (const int c : program_->idle) twists.col(c).setZero();
  if (program_->grows) {
    program_->grow(walked, load, twists);
    walked.pose.position += program_->growth(walked, load);
  }
  for (const int c : program_->turning) {
    const Vec3 axis = twists.col(c).tail<3>(), lever = walked.pose.position - twists.col(c).head<3>();
    twists.col(c).head<3>() = axis.cross(lever);
  }
  return walked.pose;
}

}  // namespace kinfer
