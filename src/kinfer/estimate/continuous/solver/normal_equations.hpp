// SPDX-License-Identifier: Apache-2.0
// Normal equations of a whole recording, reduced to the global parameters by block elimination.
//
// The recording is cut into time segments of fixed length. Each is linearised and condensed to its end coefficients on
// its own thread (linalg), the ends and the global parameters are solved, then the inner coefficients follow by
// back-substitution. Factors of the segments are kept if they are small and otherwise recomputed, so an hour needs
// little more memory than a minute. Time-varying biases are unknowns between the segments' ends. The segments depend on
// the recording only, so results are the same for any number of threads.
#pragma once

#include "kinfer/estimate/continuous/model/bias_process.hpp"
#include "kinfer/estimate/continuous/solver/linearisation.hpp"
#include "kinfer/linalg/band_segment.hpp"

namespace kinfer {

struct Damping {
  double band = 0.0, border = 0.0;       ///< times the diagonal (Marquardt)
  bool holds_global_parameters = false;  ///< global parameters and biases are held: much less work
};

/// Values of all splines at one time, as they follow the global parameters.
struct SplineMarginal {
  MatrixXd by_global_parameters;  ///< derivative, dimensions x global parameters
  MatrixXd conditional;           ///< covariance with the global parameters given, dimensions x dimensions
};

class InsSystem {
 public:
  /// At x; the arguments must outlive the system. Up to `most_kept` [bytes] of factors are kept rather than recomputed.
  InsSystem(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const Damping& damping,
            int threads, double most_kept = 96.0 * 1048576);

  bool is_positive_definite() const { return ends_.is_positive_definite(); }  ///< precondition of all functions below

  /// The step that solves the equations; empty if they are not positive definite.
  std::optional<InsStep> solve() const;

  /// Information on the global parameters with the spline coefficients marginalised.
  const MatrixXd& schur() const { return ends_.schur(); }

  struct Scores {
    MatrixXd blocks;  ///< blocks x global parameters
    MatrixXd priors;  ///< global x global: prior information, including that on time-varying biases
  };
  /// Gradient of the measurement cost with respect to the global parameters, spline coefficients and biases eliminated,
  /// summed over blocks of `seconds`. The rows sum to about zero at the optimum; their spread is the empirical
  /// information.
  Scores scores(double seconds) const;

  /// The conditional covariance is that at the begin of the time segment.
  SplineMarginal spline_marginal(double time) const;

 private:
  struct Condensed {
    BandSpan span;
    MatrixXd border_matrix;
    VectorXd border_right;
    bool is_positive_definite = false;
    std::optional<BandSegment> kept;
  };
  Condensed condensed(std::size_t time_segment, bool keep) const;
  BandSpan with_bias_process(const BandSpan& ends, const BandSegment& band, std::size_t time_segment) const;
  void add_bias_process_prior(BandSpan& span, std::size_t time_segment) const;
  std::optional<VectorXd> global_step_of(std::size_t time_segment, const BorderedBand::Solution& ends) const;
  BandSegment eliminated(const TimeSegment& time_segment) const;
  MatrixXd between(std::size_t time_segment, const BorderedBand::Solution& ends) const;
  struct Following {
    MatrixXd border, coefficients;  // change of the border as the segment sees it; minus that of the coefficients
  };
  Following following(std::size_t time_segment, ConstMatrixRef ends_following) const;
  MatrixXd segment_scores(std::size_t time_segment, ConstMatrixRef ends_following) const;
  MatrixXd prior_information(ConstMatrixRef ends_following) const;
  Eigen::Index end_width() const { return (spline_order - 1) * layout_.spline_dimensions; }

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  Damping damping_;
  int threads_;
  Eigen::Index border_, bias_process_;  // global parameters, and unknowns of each segment; 0 if held
  InsLinearisation linearisation_;
  std::vector<TimeSegment> segments_;
  std::vector<Eigen::Index> bias_parameters_;  // global parameters that a segment's bias deviations add to
  BorderedBand ends_;                          // groups: [end, bias deviations in the segment behind it]
  std::vector<BandSegment> kept_;              // all segments, or none
};

}  // namespace kinfer
