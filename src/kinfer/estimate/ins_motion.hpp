// How every body of the machine moves at a node of an interval, with its derivatives by the coefficients of the band
// and by the unknowns that hold for good.
#pragma once

#include "kinfer/estimate/ins_problem.hpp"

namespace kinfer {

/// What a column of a body's state derivatives stands for.
struct InsColumn {
  Eigen::Index border = -1;              // unknown that holds for good
  Eigen::Index channel = -1, order = 0;  // else: derivative of the band's channel
};

/// How the unknowns reach each body.
struct InsPaths {
  std::vector<std::vector<InsColumn>> columns;      // of each body
  std::vector<std::vector<Eigen::Index>> channels;  // of each body
};

InsPaths paths_of(const InsProblem& problem, const InsLayout& layout, const InsBodies& bodies);

/// Bases at the nodes; the same in every interval.
std::array<SplineBasis, block_nodes> node_bases(const SplineGrid& grid);

/// States of all bodies at the place of an interval that `basis` belongs to.
std::vector<InsState> body_states(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x,
                                  Eigen::Index interval, const SplineBasis& basis);

/// States of all bodies at one node with their derivatives.
struct NodeMotion {
  std::vector<InsState> state;
  std::vector<StateColumns> columns;
};

NodeMotion node_motion(const InsProblem& problem, const InsLayout& layout, const InsUnknowns& x, Eigen::Index interval,
                       const SplineBasis& basis);

}  // namespace kinfer
