// How every body of the machine moves at the nodes of an interval, with its derivatives by the coefficients of the band
// and by the unknowns that hold for good.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

inline Eigen::Index number_of(const std::vector<Eigen::Index>& unknowns) {
  return static_cast<Eigen::Index>(unknowns.size());
}

/// The unknowns that reach a body's state.
struct InsPath {
  std::vector<Eigen::Index> channels;  ///< of the band, ascending
  std::vector<Eigen::Index> turning;   ///< of the border: what turns frames, and the root's field
  std::vector<Eigen::Index> shifting;  ///< of the border: what forces alone depend on: points, and the root's force
};
std::vector<InsPath> paths_of(const InsProblem& problem, const InsLayout& layout, const InsBodies& bodies);

/// Bases at the nodes; the same in every interval.
std::array<SplineBasis, block_nodes> node_bases(const SplineGrid& grid);

/// States of all bodies at the place of an interval that `basis` belongs to.
std::vector<InsState> body_states(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                  Eigen::Index interval, const SplineBasis& basis);

constexpr Eigen::Index channel_orders = 3;  // derivatives by time of a channel, 0 .. 2, that states depend on

/// One body's states at the nodes and how they follow the unknowns of its path. Column component·nodes + node of the
/// derivatives is that of a state's component (as StateColumns has them) at a node.
struct BodyMotion {
  std::array<InsState, block_nodes> state;
  MatrixXd band;      ///< channels·orders x 12·nodes: by each channel's derivatives by time
  MatrixXd turning;   ///< unknowns x 12·nodes
  MatrixXd shifting;  ///< unknowns x 3·nodes: of the force
};

/// What a linearisation is asked for.
enum class InsScope {
  everything,
  band  ///< what holds for good is held
};

/// All bodies in one interval after the other; what it is made from must outlive it.
class IntervalMotion {
 public:
  IntervalMotion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, InsScope scope);

  void go_to(Eigen::Index interval);

  const InsPath& path(std::size_t body) const { return paths_[body]; }
  const BodyMotion& body(std::size_t body) const { return bodies_[body]; }
  const std::array<SplineBasis, block_nodes>& bases() const { return bases_; }

 private:
  void start_root();
  void carry_on(std::size_t body, Eigen::Index node);
  void put_own(std::size_t body, Eigen::Index node);

  const InsProblem& problem_;
  const InsLayout& layout_;
  const InsUnknowns& x_;
  InsScope scope_;
  std::array<SplineBasis, block_nodes> bases_;
  std::vector<InsPath> paths_;
  std::vector<BodyMotion> bodies_;
  std::vector<CarriedDerivative> carried_;  // of each body, to be used again
};

}  // namespace kinfer
