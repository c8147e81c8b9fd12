// Normal equations of a whole recording, eliminated up to the unknowns that hold for good.
//
// The recording is cut into stretches of fixed length. Each is linearised and condensed to its ends on a thread of its
// own (linalg/band_stretch), the ends and the border are solved, then each stretch fills in what lies between. What a
// stretch's elimination leaves behind is kept where it is small, else it is made again: so an hour needs little more
// memory than a minute. Biases that wander are unknowns between the stretches' ends. The stretches depend on the
// recording alone, so results are the same for any number of threads.
#pragma once

#include "kinfer/estimate/ins_linearisation.hpp"
#include "kinfer/estimate/ins_wander.hpp"
#include "kinfer/linalg/band_stretch.hpp"

namespace kinfer {

struct Damping {
  double band = 0.0, border = 0.0;  ///< times the diagonal (Marquardt)
  bool holds_border = false;        ///< what holds for good stays as it is, and so do the biases: much less work
};

class InsSystem {
 public:
  /// At x; the arguments must outlive the system. `most_kept` [bytes] of factors are kept rather than made again.
  InsSystem(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, const Damping& damping,
            int threads, double most_kept = 96.0 * 1048576);

  bool positive() const { return ends_.positive(); }  ///< false: nothing below may be asked for

  /// The step that solves the equations; nothing where they are not positive definite.
  std::optional<InsStep> solve() const;

  /// The information on the border when the band is free.
  const MatrixXd& schur() const { return ends_.schur(); }

  struct Scores {
    MatrixXd blocks;  ///< blocks x border
    MatrixXd priors;  ///< border x border: what priors say, that on wandering biases with these following
  };
  /// Gradient of the readings in the border's unknowns when band and biases follow, summed over blocks of so many
  /// seconds. Its rows sum to about zero at the optimum, their spread is what the data really say.
  Scores scores(double seconds) const;

 private:
  struct Condensed {
    BandSpan span;
    MatrixXd border_matrix;
    VectorXd border_right;
    bool positive = false;
    std::optional<BandStretch> kept;
  };
  Condensed condensed(std::size_t stretch, bool keep) const;
  BandSpan with_wander(const BandSpan& ends, const BandStretch& band, std::size_t stretch) const;
  void add_wander_prior(BandSpan& span, std::size_t stretch) const;
  std::optional<VectorXd> border_of(std::size_t stretch, const BorderedBand::Solution& ends) const;
  BandStretch eliminated(const InsStretch& stretch) const;
  MatrixXd between(std::size_t stretch, const BorderedBand::Solution& ends) const;
  MatrixXd stretch_scores(std::size_t stretch, ConstMatrixRef ends_following) const;
  MatrixXd prior_information(ConstMatrixRef ends_following) const;
  Eigen::Index end_width() const { return (spline_order - 1) * layout_.channels; }

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  Damping damping_;
  int threads_;
  Eigen::Index border_, wander_;  // unknowns for good and of each stretch, none where they are held
  InsLinearisation linearisation_;
  std::vector<InsStretch> stretches_;
  std::vector<Eigen::Index> wandering_;  // border unknowns that a stretch's own are added to
  BorderedBand ends_;                    // groups: [end, what the biases wandered off in the stretch behind it]
  std::vector<BandStretch> kept_;        // all stretches, or none
};

}  // namespace kinfer
