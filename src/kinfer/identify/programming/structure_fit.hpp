// SPDX-License-Identifier: Apache-2.0
// Fits the parameters of a chain of given structure, in closed form as far as possible.
//
// Lengths d and a and the accelerometers' biases are linear in the accelerations, so they are eliminated (variable
// projection, Golub and Pereyra 1973); unobservable lengths are the shortest ones. The angles are initialised from the
// orientations alone: Σ |R − R~|² is a sinusoid in each angle, so a sweep over the angles finds the optimum of each one
// in closed form, from three moments of the recording. Levenberg-Marquardt on all residuals follows.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kinfer/identify/programming/link_cost.hpp"
#include "kinfer/identify/programming/link_structure.hpp"

namespace kinfer::identify {

struct StructureFitOptions {
  double length_prior = 1e-3;  ///< [m/s² per m] adds (length_prior · length)² to J²: keeps unobservable lengths short
  double bias_prior = 0.1;     ///< [m/s² per m/s²] likewise for the biases
  int max_iterations = 12;     ///< Levenberg-Marquardt steps
  double rejection_ratio = 2.0;  ///< times J of the general revolute joint: structures above it are not refined
};

struct StructureFit {
  std::vector<DhLeaf> leaves;
  double j = 0.0;                ///< eq. (20) of paper 1 with biases removed, priors included
  std::int64_t evaluations = 0;  ///< passes over all rows, partial ones added up; a derivative counts as one
  bool is_refined = false;       ///< false: rejected by the orientations or by an eighth of the rows, to which j refers
};

/// Fits structures of one link with one signal. The fit of a structure depends on that structure only, so calls from
/// several threads are safe.
class StructureFitter {
 public:
  StructureFitter(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
                  std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
                  const StructureFitOptions& options);
  ~StructureFitter();

  StructureFit fit(const LinkStructure& structure) const;

  /// Effective number of independent samples in the accelerations of the rows.
  double effective_sample_count() const { return effective_sample_count_; }

 private:
  struct Normal;
  struct AngleStart {
    std::vector<DhLeaf> leaves;
    double square = 0.0;  // [rad²] mean squared chord
  };
  AngleStart initial_angles(const LinkStructure& structure) const;
  Normal normal(const LinkStructure& structure, const std::vector<DhLeaf>& leaves, std::span<const LinkBlock> blocks,
                bool with_angles) const;
  double screening_cost(const LinkStructure& structure, const std::vector<DhLeaf>& leaves, std::int64_t& eighths) const;
  StructureFit fit_all_parameters(const LinkStructure& structure, std::vector<DhLeaf> leaves,
                                  std::int64_t eighths) const;

  std::vector<LinkBlock> blocks_;
  std::size_t rows_ = 0, screening_blocks_ = 1;  // screening_blocks_: blocks of the screening
  std::array<Mat3, 3> moments_;                  // Σ R, Σ cos q R, Σ sin q R with R parent_R_child
  StructureFitOptions options_;
  double revolute_chord_ = -1.0, revolute_screening_ = 0.0,
         revolute_j_ = 0.0;  // of revolute_structure(): chord², screening, J
  double effective_sample_count_ = 1.0;
};

}  // namespace kinfer::identify
