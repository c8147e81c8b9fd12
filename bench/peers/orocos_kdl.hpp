// SPDX-License-Identifier: Apache-2.0
// Orocos KDL's recursive forward kinematics and Levenberg-Marquardt inverse kinematics of the same chain.
#pragma once

#include <memory>

namespace kinfer::bench {

class KdlChain {
 public:
  /// x: a, alpha, d, theta of six rows, modified DH.
  explicit KdlChain(const double* x);
  ~KdlChain();
  KdlChain(const KdlChain&) = delete;
  KdlChain& operator=(const KdlChain&) = delete;

  void position(const double* q, double* at);

  /// Solution of the pose (rotation by rows, then position) to 1e-9 from `start`, revolutions removed; false where the
  /// search fails or a joint is beyond ± limit [rad].
  bool inverse(const double* start, const double* pose, double limit, double* q);

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace kinfer::bench
