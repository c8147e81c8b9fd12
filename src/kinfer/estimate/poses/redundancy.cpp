// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/poses/redundancy.hpp"

#include <algorithm>
#include <vector>

#include "kinfer/estimate/poses/pose_normal_equations.hpp"
#include "kinfer/linalg/decompositions.hpp"

namespace kinfer {
namespace {

constexpr double negligible_share = 0.02;  // of a kind's residuals: 1 % of its standard deviation
constexpr double least_redundancy = 1e-6;  // of a kind that is fitted exactly: rounding

double residuals_of(const PoseSet& data, const ResidualKind& kind) {
  return kind.size * static_cast<double>(kind.count(data));
}

/// Where one kind was measured alone, or even that of the fewest residuals can have absorbed next to nothing.
bool is_equal(const PoseSet& data, double parameters) {
  const auto measured =
      std::ranges::count_if(residual_kinds(), [&](const ResidualKind& kind) { return kind.count(data) > 0; });
  return measured < 2 || std::ranges::all_of(residual_kinds(), [&](const ResidualKind& kind) {
           const double residuals = residuals_of(data, kind);
           return residuals == 0.0 || parameters < negligible_share * residuals;
         });
}

/// What one kind says of the parameters, without their priors: unknowns x unknowns.
MatrixXd information_of(MeasurementKind kind, const Chain& chain, const ParameterSet& set, const PoseSet& data,
                        const Weights& weights, int threads) {
  std::vector<bool> kept;
  for (const Block& block : blocks_of(data)) kept.push_back(block.kind == kind);
  const PoseSet own = keep_measurements(data, kept);
  Weights own_weights;
  own_weights.of(kind) = weights.of(kind);
  NormalEquations normal;
  pose_normal_problem(chain, set, own, own_weights, {}, threads).linearise(pack(set, chain), normal);
  normal.matrix -= prior_information(set).triangularView<Eigen::Lower>().toDenseMatrix();
  return normal.matrix.selfadjointView<Eigen::Lower>();
}

}  // namespace

RedundancyOfKinds redundancy_of_kinds(const Chain& chain, const ParameterSet& set, const PoseSet& data,
                                      const Weights& weights, const AbsorbedResiduals& absorbed, int threads) {
  if (is_equal(data, absorbed.all())) return equal_redundancy(data, absorbed.all());
  std::array<MatrixXd, measurement_kinds> information;
  MatrixXd all = prior_information(set).selfadjointView<Eigen::Lower>();
  for (const ResidualKind& kind : residual_kinds()) {
    if (kind.count(data) == 0) continue;
    information[index(kind.kind)] = information_of(kind.kind, chain, set, data, weights, threads);
    all += information[index(kind.kind)];
  }
  const MatrixXd covariance = invert_but_for_rounding(all);
  RedundancyOfKinds redundancy = equal_redundancy(data, absorbed.by_functions);
  for (const ResidualKind& kind : residual_kinds()) {
    const auto k = index(kind.kind);
    if (information[k].size() == 0) continue;
    const double own = information[k].cwiseProduct(covariance).sum();
    redundancy[k] *= std::max(least_redundancy, 1.0 - own / residuals_of(data, kind));
  }
  return redundancy;
}

ExcessNoise noise_of_fit(const Chain& chain, const ParameterSet& set, const PoseSet& data,
                         const std::optional<Instrument>& instrument, double parameters, int threads) {
  constexpr int rounds = 4;  // of noise and redundancy, which settle as quickly as those of the fit
  ExcessNoise noise = excess_noise(chain, data, instrument, parameters, threads);
  if (is_equal(data, parameters)) return noise;
  for (int i = 0; i < rounds; ++i)
    noise = excess_noise(chain, data, instrument,
                         redundancy_of_kinds(chain, set, data, weights_of(data, instrument, noise),
                                             {.by_parameters = parameters}, threads),
                         threads);
  return noise;
}

}  // namespace kinfer
