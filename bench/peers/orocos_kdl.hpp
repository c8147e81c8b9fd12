// SPDX-License-Identifier: Apache-2.0
// Orocos KDL's recursive forward kinematics of the same chain.
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

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace kinfer::bench
