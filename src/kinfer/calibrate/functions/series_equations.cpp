// SPDX-License-Identifier: Apache-2.0
#include "kinfer/calibrate/functions/series_equations.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "kinfer/base/parallel.hpp"
#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/linalg/products.hpp"

namespace kinfer::calibrate {
namespace {

using Eigen::Index;

std::vector<SeriesBlock> make_blocks(const Chain& plain, const std::vector<JointSeries>& series, const PoseSet& rows,
                                     Index behind) {
  const std::vector<int> q_index = active_joint_indices(plain);
  std::vector<SeriesBlock> blocks;
  for (const JointSeries& s : series) {
    const int knots = s.resolution.knots;
    SeriesBlock block{s.joint, knots, std::vector<Index>(static_cast<std::size_t>(knots), -1), behind};
    for (const double q : rows.joints.row(q_index[s.joint]))
      for (const int knot : knots_at(q, knots).knot) block.unknown[static_cast<std::size_t>(knot)] = 0;
    for (Index& unknown : block.unknown)
      if (unknown == 0) unknown = behind++;
    block.count = behind - block.begin;
    blocks.push_back(std::move(block));
  }
  return blocks;
}

/// Residuals at a chain and their derivatives by its free parameters and by the variables of the joints with series.
struct Linearised {
  MatrixXd among_parameters;  // Jᵀ J
  MatrixXd by_parameter;      // J transposed: parameters x residuals
  MatrixXd by_joint;          // series x residuals
  VectorXd residuals;
  std::vector<int> pose;  // of each residual; -1: none
};

Linearised linearise(Chain chain, const ParameterSet& set, const WeightedRows& data,
                     const std::vector<SeriesBlock>& blocks) {
  ParameterSet all{set.parameters, {}};
  for (const SeriesBlock& block : blocks) {  // the cosine of order 0 is 1: its column is that of the joint variable
    std::vector<Harmonic>& harmonics = chain.joints[block.joint].harmonics;
    harmonics.push_back({0.0});
    const int term = static_cast<int>(harmonics.size()) - 1;
    all.parameters.push_back(parameter_at(chain, JointNumber{block.joint, Field::cosine, term}, 1.0));
  }
  VectorXd r;
  MatrixXd jacobian;
  pose_residuals(chain, all, data.rows, data.weights, data.threads).evaluate(pack(all, chain), r, &jacobian);
  const Index parameters = set.free_count(), count = r.size() - all.free_count();
  Linearised at{gram(jacobian.topLeftCorner(count, parameters)), jacobian.topLeftCorner(count, parameters).transpose(),
                jacobian.topRows(count).rightCols(static_cast<Index>(blocks.size())).transpose(), r.head(count),
                std::vector<int>(static_cast<std::size_t>(count), -1)};
  std::size_t row = 0;  // behind the blocks follow socket distances, on which no joint acts
  for (const Block& block : blocks_of(data.rows))
    for (int k = 0; k < block.size; ++k) at.pose[row++] = block.row;
  return at;
}

/// Sums over some of the residuals.
struct SeriesSums {
  MatrixXd among_series;  // lower half
  MatrixXd across;        // parameters x series
  VectorXd gradient;
};

SeriesSums sums_of(const Linearised& at, const std::vector<SeriesBlock>& blocks, const MatrixXd& positions, Index first,
                   Index end) {
  const Index parameters = at.by_parameter.rows(), behind = blocks.back().begin + blocks.back().count - parameters;
  SeriesSums sums{MatrixXd::Zero(behind, behind), MatrixXd::Zero(parameters, behind), VectorXd::Zero(behind)};
  std::vector<std::pair<Index, double>> acting;  // coefficients and derivatives of one residual
  for (Index row = first; row < end; ++row) {
    const int pose = at.pose[static_cast<std::size_t>(row)];
    if (pose < 0) continue;
    acting.clear();
    for (std::size_t s = 0; s < blocks.size(); ++s) {
      const double slope = at.by_joint(static_cast<Index>(s), row);
      const ActingKnots knots = knots_at(positions(static_cast<Index>(s), pose), blocks[s].knots);
      for (int k = 0; k < 4; ++k)
        acting.emplace_back(blocks[s].unknown[static_cast<std::size_t>(knots.knot[k])] - parameters,
                            slope * knots.weight[k]);
    }
    for (const auto& [i, value] : acting) {
      sums.across.col(i) += value * at.by_parameter.col(row);
      sums.gradient[i] += value * at.residuals[row];
      for (const auto& [k, other] : acting)
        if (k <= i) sums.among_series(i, k) += value * other;
    }
  }
  return sums;
}

}  // namespace

SeriesSystem make_system(const DetachedSeries& apart, const WeightedRows& data) {
  constexpr Index residuals_a_part = 8192;  // whatever the threads, so that the sums are the same
  const auto& [plain, set, series] = apart;
  const Index p = set.free_count();
  SeriesSystem system{make_blocks(plain, series, data.rows, p), {}, {}};
  const Linearised at = linearise(plain, set, data, system.blocks);
  const Index unknowns = system.blocks.empty() ? p : system.blocks.back().begin + system.blocks.back().count;
  system.matrix = MatrixXd::Zero(unknowns, unknowns), system.gradient = VectorXd::Zero(unknowns);
  system.matrix.topLeftCorner(p, p) = at.among_parameters;
  system.gradient.head(p) = at.by_parameter * at.residuals;
  system.squares = at.residuals.squaredNorm(), system.residuals = at.residuals.size();
  if (system.blocks.empty()) return system;
  const std::vector<int> q_index = active_joint_indices(plain);
  MatrixXd positions(static_cast<Index>(system.blocks.size()), data.rows.rows());
  for (std::size_t s = 0; s < system.blocks.size(); ++s)
    positions.row(static_cast<Index>(s)) = data.rows.joints.row(q_index[system.blocks[s].joint]);
  std::vector<SeriesSums> sums(static_cast<std::size_t>(1 + system.residuals / residuals_a_part));
  parallel_for(sums.size(), data.threads, [&](std::size_t k) {
    const Index first = residuals_a_part * static_cast<Index>(k);
    sums[k] = sums_of(at, system.blocks, positions, first, std::min(first + residuals_a_part, system.residuals));
  });
  const Index n = unknowns - p;
  for (const SeriesSums& part : sums) {
    system.matrix.bottomRightCorner(n, n) += part.among_series;
    system.matrix.bottomLeftCorner(n, p) += part.across.transpose();
    system.gradient.tail(n) += part.gradient;
  }
  return system;
}

}  // namespace kinfer::calibrate
