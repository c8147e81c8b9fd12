// SPDX-License-Identifier: Apache-2.0
#include "peers/orocos_kdl.hpp"

#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>

#include <cmath>
#include <numbers>

namespace kinfer::bench {
namespace {

/// A KDL segment rotates first: its frame holds the constant transform between two joints.
KDL::Chain chain_of(const double* x) {
  using KDL::Frame, KDL::Rotation, KDL::Vector;
  const auto row = [x](int j) {
    return Frame(Rotation::RotX(x[4 * j + 1])) * Frame(Vector(x[4 * j], 0, 0)) * Frame(Rotation::RotZ(x[4 * j + 3]));
  };
  KDL::Chain chain;
  chain.addSegment(KDL::Segment("base", KDL::Joint("fixed"), row(0)));
  for (int j = 0; j < 6; ++j) {
    const Frame after = Frame(Vector(0, 0, x[4 * j + 2]));
    chain.addSegment(KDL::Segment("link", KDL::Joint("joint", KDL::Joint::RotZ), j < 5 ? after * row(j + 1) : after));
  }
  return chain;
}

}  // namespace

struct KdlChain::Solver {
  KDL::Chain chain;
  KDL::ChainFkSolverPos_recursive solver{chain};
  KDL::ChainIkSolverPos_LMA inverse{chain, 1e-9, 200};
  KDL::JntArray q{6}, found{6};
  explicit Solver(const double* x) : chain(chain_of(x)) {}
};

KdlChain::KdlChain(const double* x) : solver_(std::make_unique<Solver>(x)) {}
KdlChain::~KdlChain() = default;

void KdlChain::position(const double* q, double* at) {
  for (int j = 0; j < 6; ++j) solver_->q(j) = q[j];
  KDL::Frame pose;
  solver_->solver.JntToCart(solver_->q, pose);
  for (int i = 0; i < 3; ++i) at[i] = pose.p[i];
}

bool KdlChain::inverse(const double* start, const double* pose, double limit, double* q) {
  for (int j = 0; j < 6; ++j) solver_->q(j) = start[j];
  const KDL::Rotation rotation(pose[0], pose[1], pose[2], pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]);
  const KDL::Frame target(rotation, KDL::Vector(pose[9], pose[10], pose[11]));
  if (solver_->inverse.CartToJnt(solver_->q, target, solver_->found) < 0) return false;
  for (int j = 0; j < 6; ++j) {
    q[j] = std::remainder(solver_->found(j), 2.0 * std::numbers::pi);
    if (std::abs(q[j]) > limit) return false;
  }
  return true;
}

}  // namespace kinfer::bench
