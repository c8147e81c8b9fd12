// SPDX-License-Identifier: Apache-2.0
#include "kinfer/track/faults/exchange.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "kinfer/track/faults/thresholds.hpp"
#include "kinfer/track/rows/row_block.hpp"
#include "kinfer/track/start/settled_start.hpp"
#include "kinfer/track/start/thresholds.hpp"

namespace kinfer::track {
namespace {

using Rows = std::span<const BlockMeasurement>;

struct Explained {
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double inflation = 0.0;  ///< largest factor on the sensors' variances at the end
};

/// Rows of the first `start_length` seconds.
Rows first_of(Rows rows) {
  std::size_t count = 1;
  while (count < rows.size() && rows[count].time - rows.front().time < start_length) ++count;
  return rows.first(count);
}

double largest_inflation(const ChainFilter& filter) {
  double largest = 1.0;
  for (std::size_t s = 0; s < filter.model().sensors.size(); ++s)
    largest = std::max({largest, filter.levels().of(s).rate, filter.levels().of(s).force});
  return largest;
}

Explained explain(const std::shared_ptr<const FilterModel>& model, Rows rows, const std::vector<PositionGuess>& guesses,
                  BaseMode base) {
  const Rows first = first_of(rows);
  const BlockMeasurement mean = mean_of(first);
  ChainFilter filter(model);
  InitialPosture posture = initial_posture(*model, mean, guesses, base);
  settle(posture, filter, first);
  start_in(posture, filter);
  Explained explained{.log_likelihood = 0.0};
  for (const BlockMeasurement& block : rows) {
    if (block.time <= filter.state().time) continue;
    filter.predict(block.time);
    filter.update(block);
    explained.log_likelihood += filter.innovations().log_likelihood;
    if (block.time - rows.front().time > 2.0 * start_length)
      explained.inflation = std::max(explained.inflation, largest_inflation(filter));
    if (filter.levels().common() > misfit_inflation) return {};
  }
  return explained;
}

std::vector<BlockMeasurement> exchanged(Rows rows, std::size_t a, std::size_t b) {
  std::vector<BlockMeasurement> changed(rows.begin(), rows.end());
  for (BlockMeasurement& block : changed) std::swap(block.sensors[a], block.sensors[b]);
  return changed;
}

}  // namespace

std::optional<Exchange> find_exchange(const std::shared_ptr<const FilterModel>& model, Rows rows,
                                      const std::vector<PositionGuess>& guesses, BaseMode base) {
  if (rows.empty() || first_of(rows).size() == rows.size()) return {};
  std::optional<Exchange> best;
  double most = explain(model, rows, guesses, base).log_likelihood + exchange_log_odds;
  for (std::size_t a = 0; a < model->sensors.size(); ++a)
    for (std::size_t b = a + 1; b < model->sensors.size(); ++b) {
      const Explained found = explain(model, exchanged(rows, a, b), guesses, base);
      if (!(found.log_likelihood > most) || found.inflation > exchange_inflation) continue;
      most = found.log_likelihood;
      best = Exchange{a, b, rows.back().time};
    }
  return best;
}

ExchangeWatch::ExchangeWatch(std::shared_ptr<const FilterModel> model)
    : model_(std::move(model)), recent_(exchange_blocks) {
  for (BlockMeasurement& block : recent_) block.sensors.resize(model_->sensors.size());
}

void ExchangeWatch::suspect(bool is_suspected) {
  if (is_suspected && !is_suspected_) since_trial_ = 0, trials_ = most_exchange_trials;
  is_suspected_ = is_suspected;
}

void ExchangeWatch::add(const BlockMeasurement& block, const std::vector<PositionGuess>& guesses, BaseMode base) {
  recent_[next_] = block;
  next_ = (next_ + 1) % recent_.size();
  if (found_ || trials_ == 0 || ++since_trial_ < recent_.size()) return;
  since_trial_ = 0;
  --trials_;
  std::vector<BlockMeasurement> rows = recent_;
  std::rotate(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(next_), rows.end());
  const std::optional<Exchange> now = find_exchange(model_, rows, guesses, base);
  if (now && likely_ && now->first == likely_->first && now->second == likely_->second)
    found_ = now;
  else if (now)
    ++trials_;  // it is seen again, or was the chance of some seconds in which another fault shows
  likely_ = now;
}

}  // namespace kinfer::track
