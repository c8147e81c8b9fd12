// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/held_out.hpp"

#include <utility>

namespace kinfer::identify {
namespace {

using Index = Eigen::Index;
using Intervals = std::vector<std::pair<Index, Index>>;

constexpr Index held_out_window_count = 5;
constexpr double held_out_share = 0.2;  // of each fifth, centred in it
constexpr int refit_iterations = 2;     // no settling of the motion needed: it was fitted to all measurements

/// Removes the measurements of the held-out intervals from a problem in this object's scope, and restores them at its
/// end.
class ScopedExclusion {
 public:
  ScopedExclusion(InsProblem& problem, const Intervals& intervals) : problem_(problem), intervals_(intervals) {
    for (const InsMeasurements& r : problem.sensors) noise_.push_back(r.noise);
    InsBlock empty;
    empty.factor.setZero();
    empty.target.setZero();
    visit_blocks([&](InsBlock& block) { kept_.push_back(std::exchange(block, empty)); });
  }
  ~ScopedExclusion() {
    std::size_t next = 0;
    visit_blocks([&](InsBlock& block) { block = kept_[next++]; });
    for (std::size_t s = 0; s < noise_.size(); ++s) problem_.sensors[s].noise = noise_[s];
  }
  ScopedExclusion(const ScopedExclusion&) = delete;
  ScopedExclusion& operator=(const ScopedExclusion&) = delete;

 private:
  template <class Visit>
  void visit_blocks(const Visit& visit) {
    for (InsMeasurements& r : problem_.sensors)
      for (auto* blocks : {&r.angular_velocity, &r.force, &r.clipped_rate.blocks, &r.clipped_force.blocks})
        if (!blocks->empty())
          for (const auto& [begin, end] : intervals_)
            for (Index k = begin; k < end; ++k) visit((*blocks)[static_cast<std::size_t>(k)]);
  }

  InsProblem& problem_;
  const Intervals& intervals_;
  std::vector<InsBlock> kept_;
  std::vector<InsNoise> noise_;
};

}  // namespace

Intervals held_out_intervals(const SplineGrid& grid) {
  Intervals intervals;
  const double part = static_cast<double>(grid.intervals) / static_cast<double>(held_out_window_count);
  for (Index i = 0; i < held_out_window_count; ++i) {
    const double middle = part * (static_cast<double>(i) + 0.5), half = 0.5 * held_out_share * part;
    const auto begin = static_cast<Index>(middle - half), end = static_cast<Index>(middle + half);
    if (end > begin) intervals.emplace_back(begin, end);
  }
  return intervals;
}

InsFit fit_without_intervals(InsProblem& problem, const InsUnknowns& found, const Intervals& intervals,
                             const InsFitOptions& options) {
  const ScopedExclusion exclusion(problem, intervals);
  InsFitOptions short_options = options;
  short_options.iterations = refit_iterations;
  short_options.trajectory_iterations = 0;
  short_options.reweighting_rounds = 1;
  return fit_ins(problem, found, short_options);
}

}  // namespace kinfer::identify
