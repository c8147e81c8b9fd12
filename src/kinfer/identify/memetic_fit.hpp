// The numbers of a chain whose structure is given: the constants in closed form as far as they go.
//
// Lengths d and a, and the accelerometers' biases, are linear in the accelerations, so they are solved (variable
// projection, Golub and Pereyra 1973), the shortest ones where no signal tells. The angles start where the orientations
// alone want them: Σ |R − R~|² is a sinusoid in each angle, so a sweep over the angles finds each one's best value in
// closed form, from three moments of the recording. Then Levenberg-Marquardt on all of it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kinfer/identify/link_cost.hpp"
#include "kinfer/identify/link_structure.hpp"

namespace kinfer {

struct MemeticFitOptions {
  double length_prior = 1e-3;  ///< [m/s² per m] adds (length_prior · length)² to J²: keeps what no signal sees short
  double bias_prior = 0.1;     ///< [m/s² per m/s²] likewise of the biases
  int most_steps = 12;         ///< of Levenberg-Marquardt
  double hopeless = 2.0;       ///< times the hinge's J on an eighth of the rows, beyond which nothing is refined
};

struct MemeticFit {
  std::vector<DhLeaf> leaves;
  double j = 0.0;                ///< eq. (20) of paper 1 with biases taken off, priors included
  std::int64_t evaluations = 0;  ///< passes over all rows, in eighths counted together; a derivative counts as one
  bool is_refined = false;       ///< false: given up on an eighth of the rows; j is of these
};

/// Evaluates structures of one link with one signal. Pure: the fit of a structure depends on nothing but it, so any
/// number of threads may ask.
class MemeticLink {
 public:
  MemeticLink(const std::vector<FrameState>& parent, const std::vector<FrameState>& child,
              std::span<const JointSignal> signals, const std::vector<std::size_t>& rows,
              const MemeticFitOptions& options);
  ~MemeticLink();

  MemeticFit fit(const LinkStructure& structure) const;

  /// Independent numbers that the accelerations of the rows are worth.
  double independent_numbers() const { return independent_numbers_; }

 private:
  struct Normal;
  struct Start {
    std::vector<DhLeaf> leaves;
    double square = 0.0;  // [rad²] mean squared chord
  };
  Start start(const LinkStructure& structure) const;
  Normal normal(const LinkStructure& structure, const std::vector<DhLeaf>& leaves, std::span<const LinkBlock> blocks,
                bool with_angles) const;
  double eighth_cost(const LinkStructure& structure, std::vector<DhLeaf> leaves, std::int64_t& eighths) const;
  MemeticFit refined(const LinkStructure& structure, std::vector<DhLeaf> leaves, std::int64_t eighths) const;

  std::vector<LinkBlock> blocks_;
  std::size_t rows_ = 0, eighth_ = 1;  // eighth_: blocks of the first look
  std::array<Mat3, 3> moments_;        // Σ R, Σ cos q R, Σ sin q R with R parent_R_child
  MemeticFitOptions options_;
  double hinge_square_ = -1.0, hinge_eighth_ = 0.0, hinge_j_ = 0.0;  // of any hinge: by orientation, first look, J
  double independent_numbers_ = 1.0;
};

}  // namespace kinfer
