#include "kinfer/identify/held_out.hpp"

#include <utility>

namespace kinfer {
namespace {

using Index = Eigen::Index;
using Intervals = std::vector<std::pair<Index, Index>>;

constexpr Index windows = 5;
constexpr double share = 0.2;  // of each fifth, in its middle
constexpr int few_steps = 2;   // the motion need not settle first: it was found with all readings

/// The readings of the held-out intervals, lifted out of a problem until this goes.
class Lifted {
 public:
  Lifted(InsProblem& problem, const Intervals& intervals) : problem_(problem), intervals_(intervals) {
    for (const InsReadings& r : problem.sensors) noise_.push_back(r.noise);
    InsBlock empty;
    empty.factor.setZero();
    empty.target.setZero();
    each([&](InsBlock& block) { kept_.push_back(std::exchange(block, empty)); });
  }
  ~Lifted() {
    std::size_t next = 0;
    each([&](InsBlock& block) { block = kept_[next++]; });
    for (std::size_t s = 0; s < noise_.size(); ++s) problem_.sensors[s].noise = noise_[s];
  }
  Lifted(const Lifted&) = delete;
  Lifted& operator=(const Lifted&) = delete;

 private:
  template <class Visit>
  void each(const Visit& visit) {
    for (InsReadings& r : problem_.sensors)
      for (auto* blocks : {&r.rate, &r.force, &r.field})
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
  const double part = static_cast<double>(grid.intervals) / static_cast<double>(windows);
  for (Index i = 0; i < windows; ++i) {
    const double middle = part * (static_cast<double>(i) + 0.5), half = 0.5 * share * part;
    const auto begin = static_cast<Index>(middle - half), end = static_cast<Index>(middle + half);
    if (end > begin) intervals.emplace_back(begin, end);
  }
  return intervals;
}

InsFit fit_without(InsProblem& problem, const InsUnknowns& found, const Intervals& intervals,
                   const InsFitOptions& options) {
  const Lifted lifted(problem, intervals);
  InsFitOptions few = options;
  few.iterations = few_steps;
  few.settling = 0;
  few.rounds = 1;
  return fit_ins(problem, found, few);
}

}  // namespace kinfer
