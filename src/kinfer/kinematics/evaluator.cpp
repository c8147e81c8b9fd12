// PoseEvaluator: runs the step lists of program.hpp.
#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/forward.hpp"
#include "kinfer/kinematics/program.hpp"

namespace kinfer {
namespace {

using elementary::Motion;
using program::Scale;
using program::Step;
using program::StepList;

/// How one joint moves: moved = gain · q[reading] + Σ factor · q[coupling] + compliance · torque.
struct Mover {
  double gain = 1.0;
  int reading = -1;
  double compliance = 0.0;
  int coupling_begin = 0, coupling_end = 0;
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
  bool pose_needs_torque = false, derivative_needs_torque = false;
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
      movers.push_back({joint.gain, reading[j], joint.compliance, begin, static_cast<int>(couplings.size())});
      pose_needs_torque |= joint.compliance != 0.0;
    }
    pose_only = program::compile(chain, {});
  }

  void take_parameters(const ParameterSet& set) {
    std::vector<program::Column> wanted;
    derivative_needs_torque = pose_needs_torque;
    for (const Parameter* p : set.free()) {
      wanted.push_back({p->at, static_cast<int>(wanted.size())});
      derivative_needs_torque |= p->at.field == Field::compliance;
    }
    columns = static_cast<Eigen::Index>(wanted.size());
    recorded = program::compile(chain, wanted);
    std::vector<bool> acts(wanted.size(), false);
    for (const Step& step : recorded.steps) {
      if (step.kind != Step::Kind::record) continue;
      KINFER_EXPECT(step.scale != Scale::reading || movers[step.source].reading >= 0,
                    "gain of joint {}, which has no reading", step.source);
      acts[step.index] = true;
      if (step.motion == Motion::turn) turning.push_back(step.index);
    }
    for (std::size_t c = 0; c < acts.size(); ++c) {
      if (!acts[c]) idle.push_back(static_cast<int>(c));
    }
  }

  double moved(int joint, const double* q, const double* torque) const {
    const Mover& mover = movers[joint];
    double sum = mover.reading >= 0 ? mover.gain * q[mover.reading] : 0.0;
    for (int c = mover.coupling_begin; c < mover.coupling_end; ++c) sum += couplings[c].factor * q[couplings[c].joint];
    return torque ? sum + mover.compliance * torque[joint] : sum;
  }

  double scale(const Step& step, const double* q, const double* torque) const {
    if (step.scale == Scale::one) return 1.0;
    return step.scale == Scale::reading ? q[movers[step.source].reading] : torque[step.source];
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

  Pose run(const StepList& list, const double* q, const double* torque, Twists* twists) const {
    Pose pose;
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
          elementary::apply(pose, Motion::turn, step.axis, step.a + moved(step.index, q, torque));
          break;
        case Step::Kind::shift_joint:
          elementary::shift(pose, step.axis, step.a + moved(step.index, q, torque));
          break;
        case Step::Kind::record:
          record(step, pose, scale(step, q, torque), *twists);
          break;
      }
    }
    return pose;
  }

  Pose run(const StepList& list, ConstVectorRef q, const Load& load, bool needs_torque, Twists* twists) const {
    KINFER_EXPECT(q.size() == readings, "{} readings for {} joints that have one", q.size(), readings);
    if (!needs_torque) return run(list, q.data(), nullptr, twists);
    if (load.payload == 0.0 && chain.masses.empty()) return run(list, q.data(), no_torque.data(), twists);
    const VectorXd torque = gravity_torques(chain, q, load);
    return run(list, q.data(), torque.data(), twists);
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
  return program_->run(program_->pose_only, q, load, program_->pose_needs_torque, nullptr);
}

Pose PoseEvaluator::pose_and_derivative(ConstVectorRef q, const Load& load, Twists& twists) const {
  twists.resize(6, program_->columns);
  Pose pose = program_->run(program_->recorded, q, load, program_->derivative_needs_torque, &twists);
  for (const int c : program_->turning) {
    const Vec3 axis = twists.col(c).tail<3>(), lever = pose.position - twists.col(c).head<3>();
    twists.col(c).head<3>() = axis.cross(lever);
  }
  for (const int c : program_->idle) twists.col(c).setZero();
  return pose;
}

}  // namespace kinfer
