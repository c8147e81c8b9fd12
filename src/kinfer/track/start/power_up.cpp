// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/start/power_up.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kinfer/base/square.hpp"
#include "kinfer/track/start/settled_start.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

/// When the rows begin. The posture was read from them, with the errors of the biases: while the rows are weighed it
/// counts as unknown.
InitialPosture unknown_posture(InitialPosture posture, const FilterModel& model, double time) {
  predict_mean(model, time - posture.state.time, posture.state);
  const auto widen = [&](Index state) { posture.covariance(state, state) += square(weighed_start_sd); };
  for (Index k = 0; k < 3; ++k) widen(BaseIndex::attitude + k);
  for (std::size_t b = 1; b < model.bodies.size(); ++b)
    if (model.bodies[b].motion != JointMotion::prismatic)
      for (Index i = 0; i < degrees_of_freedom(model.bodies[b].motion); ++i)
        widen(model.layout.joint_state(model.layout.position[b] + i));
  return posture;
}

double log_likelihood(FilterModel model, const ChainFilter& filter, const InitialPosture& posture,
                      std::span<const BlockMeasurement> rows) {
  ChainFilter trial(std::make_shared<FilterModel>(std::move(model)));
  trial.judge_as(filter);
  start_in(posture, trial);
  return trial.run(rows);
}

/// Its variance, and its weight: ln of prior and likelihood.
struct BiasChange {
  InsLevel variance{};
  double log_weight = 0.0;
};

}  // namespace

InsLevel change_of_biases(const FilterModel& model, const ChainFilter& filter, const InitialPosture& posture,
                          std::span<const BlockMeasurement> first_rows) {
  const InitialPosture unknown = unknown_posture(posture, model, first_rows.front().time);
  std::vector<BiasChange> changes;
  for (const double rate : power_up_shares)
    for (const double force : power_up_shares) {
      const InsLevel variance{square(rate) * model.power_up.rate, square(force) * model.power_up.force};
      const double prior = std::abs(rate - force) > 0.0 ? unlike_changes : 1.0;
      changes.push_back(
          {variance, std::log(prior) + log_likelihood(with_power_up(model, variance), filter, unknown, first_rows)});
    }
  const double most = std::ranges::max_element(changes, {}, &BiasChange::log_weight)->log_weight;
  InsLevel mean;
  double sum = 0.0;
  for (const BiasChange& change : changes) {
    const double weight = std::exp(change.log_weight - most);
    mean.rate += weight * change.variance.rate, mean.force += weight * change.variance.force;
    sum += weight;
  }
  return {mean.rate / sum, mean.force / sum};
}

}  // namespace kinfer::track
